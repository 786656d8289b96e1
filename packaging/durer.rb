# Homebrew formula that builds Dürer from the clone that contains this file.
class Durer < Formula
  desc "Ray tracer for learning, ray queries and rendering"
  homepage "file://#{File.expand_path("..", __dir__)}"
  license any_of: ["MIT", "Apache-2.0"]
  head "file://#{File.expand_path("..", __dir__)}", using: :git, branch: "main"

  depends_on "rust" => :build

  def install
    system "cargo", "install", *std_cargo_args(path: "crates/durer-cli")
    generate_completions_from_executable(bin/"durer", "completions")
    system bin/"durer", "man", "--folder", man1
  end

  test do
    (testpath/"scene.txt").write <<~SCENE
      PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }
      Lights { DirectionalLight { direction 0 0 -1 color 1 1 1 } }
      Group { Sphere { center 0 0 0 radius 1 } }
    SCENE
    system bin/"durer", "render", "scene.txt", "-o", "picture.png", "--size", "32x32"
    assert_path_exists testpath/"picture.png"
  end
end
