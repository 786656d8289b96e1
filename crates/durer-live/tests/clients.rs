//! Tests the server with pages, other programs, and attackers as clients.

use durer_live::{Server, SessionFiles};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread::JoinHandle;
use std::time::Duration;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

/// A server that runs in a thread and stops when it is dropped.
struct TestServer {
    address: String,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl TestServer {
    fn new(file: Option<PathBuf>) -> TestServer {
        let server = Server::bind(0, SessionFiles { file, lesson: None }).unwrap();
        let (address, stop) = (server.address().unwrap(), Arc::new(AtomicBool::new(false)));
        let stopped = stop.clone();
        let thread = Some(std::thread::spawn(move || server.run(|| stopped.load(Relaxed)).unwrap()));
        TestServer { address, stop, thread }
    }

    fn host(&self) -> &str {
        self.address["http://".len()..].split('/').next().unwrap()
    }

    fn path(&self) -> &str {
        &self.address["http://".len() + self.host().len()..]
    }

    /// Sends raw bytes and returns the response.
    fn raw(&self, request: &[u8]) -> String {
        let mut stream = TcpStream::connect(self.host()).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        // The server may close the connection early if it rejects the request.
        let _ = stream.write_all(request);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    fn get(&self, path: &str, headers: &str) -> String {
        self.raw(format!("GET {path} HTTP/1.1\r\n{headers}\r\n").as_bytes())
    }

    fn connect(&self, origin: &str) -> Result<WebSocket<TcpStream>, String> {
        let address = format!("ws://{}{}socket", self.host(), self.path());
        let mut request = address.into_client_request().unwrap();
        request.headers_mut().insert("Origin", origin.parse().unwrap());
        let stream = TcpStream::connect(self.host()).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        tungstenite::client(request, stream).map(|found| found.0).map_err(|error| error.to_string())
    }
}

impl Drop for TestServer {
    fn drop(&mut self) {
        self.stop.store(true, Relaxed);
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// Waits for the next event of the given kind and returns it.
fn wait_for_event(socket: &mut WebSocket<TcpStream>, kind: &str) -> serde_json::Value {
    loop {
        let Message::Binary(bytes) = socket.read().unwrap() else { continue };
        let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
        let answer: serde_json::Value = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
        if answer["event"]["kind"] == kind {
            return answer["event"].clone();
        }
    }
}

fn ask(socket: &mut WebSocket<TcpStream>, request: serde_json::Value) {
    let ask = serde_json::json!({ "session": 1, "id": 1, "request": request });
    socket.send(Message::text(ask.to_string())).unwrap();
}

#[test]
fn page_is_served_behind_its_token_only() {
    let server = TestServer::new(None);
    let host = format!("Host: {}\r\n", server.host());
    let page = server.get(server.path(), &host);
    assert!(page.starts_with("HTTP/1.1 200 OK") && page.contains("durer-server"), "{page}");
    assert!(page.contains("Content-Security-Policy: default-src 'self'"));
    let path = server.path().to_string();
    for (path, headers, status) in [
        ("/", host.clone(), "404"),
        ("/00000000000000000000000000000000/", host.clone(), "404"),
        (&path[..path.len() - 1], host.clone(), "404"),
        (&format!("{path}../Cargo.toml"), host.clone(), "404"),
        (&format!("{path}..%2fCargo.toml"), host.clone(), "404"),
        (&format!("{path}/etc/passwd"), host.clone(), "404"),
        (&path, "Host: evil.example\r\n".into(), "403"),
        (&path, String::new(), "403"),
        (&path, format!("{host}Origin: http://evil.example\r\n"), "403"),
        (&format!("{path}socket"), host.clone(), "426"),
    ] {
        let answer = server.get(path, &headers);
        assert!(answer.starts_with(&format!("HTTP/1.1 {status}")), "{path} {headers}: {answer}");
    }
    assert!(server.raw(b"POST / HTTP/1.1\r\nHost: localhost\r\n\r\n").starts_with("HTTP/1.1 404"));
    assert!(server.raw(b"\x16\x03\x01\x00\xff\x01\r\n\r\n").starts_with("HTTP/1.1 400"));
    assert!(server.raw(&[b'a'; 20_000]).starts_with("HTTP/1.1 400"));
}

#[test]
fn page_opens_edits_and_saves_a_scene_and_gets_conflicts() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.txt");
    let text = "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }\n\
                Materials { PhongMaterial { diffuseColor 1 0 0 } }\nGroup { MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }\n";
    std::fs::write(&file, text).unwrap();
    let server = TestServer::new(Some(file.clone()));
    let mut socket = server.connect(&format!("http://{}", server.host())).unwrap();
    ask(&mut socket, serde_json::json!({ "kind": "open", "name": "", "text": null }));
    assert_eq!(wait_for_event(&mut socket, "opened")["text"], text);
    assert_eq!(wait_for_event(&mut socket, "picture")["head"]["full_width"], 512);
    let blue = text.replace("1 0 0 } }", "0 0 1 } }");
    ask(&mut socket, serde_json::json!({ "kind": "edit", "text": blue }));
    ask(&mut socket, serde_json::json!({ "kind": "save", "force": false }));
    wait_for_event(&mut socket, "saved");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), blue);
    // Change the file in the same way as another program would.
    std::fs::write(&file, format!("# mine\n{text}")).unwrap();
    let changed = wait_for_event(&mut socket, "text");
    assert_eq!(
        (changed["from_disk"].as_bool(), changed["text"].as_str()),
        (Some(true), Some(&*format!("# mine\n{text}")))
    );
    ask(&mut socket, serde_json::json!({ "kind": "save", "force": false }));
    wait_for_event(&mut socket, "conflict");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), format!("# mine\n{text}"));
    ask(&mut socket, serde_json::json!({ "kind": "save", "force": true }));
    wait_for_event(&mut socket, "saved");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), blue);
}

#[test]
fn scenes_from_pages_read_files_in_the_folder_only() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("secret.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    let file = inner.join("scene.txt");
    std::fs::write(&file, "").unwrap();
    let server = TestServer::new(Some(file));
    let mut socket = server.connect(&format!("http://{}", server.host())).unwrap();
    ask(&mut socket, serde_json::json!({ "kind": "open", "name": "", "text": null }));
    wait_for_event(&mut socket, "scene");
    for name in ["../secret.obj", folder.path().join("secret.obj").to_str().unwrap()] {
        let text = format!(
            "PerspectiveCamera {{ center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }}\nGroup {{ TriangleMesh {{ obj_file {name} }} }}\n"
        );
        ask(&mut socket, serde_json::json!({ "kind": "edit", "text": text }));
        let scene = wait_for_event(&mut socket, "scene");
        assert!(scene["contents"].is_null(), "{name}: {scene}");
        // Another name for the scene file is also rejected.
        let elsewhere = folder.path().join("scene.txt");
        ask(&mut socket, serde_json::json!({ "kind": "open", "name": elsewhere, "text": text.replace("../", "") }));
        let scene = wait_for_event(&mut socket, "scene");
        assert!(scene["contents"].is_null(), "{name}: {scene}");
    }
}

#[test]
fn foreign_origins_and_wrong_tokens_are_refused() {
    let server = TestServer::new(None);
    assert!(server.connect("http://evil.example").is_err());
    assert!(server.connect("null").is_err());
    let mut socket = server.connect(&format!("http://{}", server.host())).unwrap();
    // The server answers an invalid message, and the socket stays open.
    socket.send(Message::text("{")).unwrap();
    wait_for_event(&mut socket, "refused");
    socket.send(Message::binary(vec![1, 2, 3])).unwrap();
    ask(&mut socket, serde_json::json!({ "kind": "language" }));
    assert!(wait_for_event(&mut socket, "language")["words"].as_array().unwrap().len() > 30);
}

/// Opens a small scene and changes the number of balls in it. Returns the number of objects in the
/// scene.
fn objects(socket: &mut WebSocket<TcpStream>, count: usize) -> Option<u64> {
    let balls: String = (0..count).map(|i| format!("Sphere {{ center {i} 0 0 radius 0.4 }} ")).collect();
    let text =
        format!("PerspectiveCamera {{ center 0 0 9 direction 0 0 -1 up 0 1 0 angle 30 }}\nGroup {{ {balls} }}\n");
    ask(socket, serde_json::json!({ "kind": "open", "name": "balls.txt", "text": text }));
    wait_for_event(socket, "scene")["contents"]["object_count"].as_u64()
}

#[test]
fn clients_that_mean_harm_lose_their_connection_and_nobody_else_does() {
    let server = TestServer::new(None);
    let origin = format!("http://{}", server.host());
    let mut page = server.connect(&origin).unwrap();
    assert_eq!(objects(&mut page, 3), Some(3));
    let mut random = 7_u64;
    let mut garbage = |length: usize| -> Vec<u8> {
        (0..length)
            .map(|_| {
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (random >> 56) as u8
            })
            .collect()
    };
    // The messages are a text whose header claims one gibibyte, a frame without a mask, one with a
    // reserved opcode, and noise.
    let mut attacks = vec![
        [vec![0x81, 0xff], (1_u64 << 30).to_be_bytes().to_vec(), vec![0; 4]].concat(),
        [vec![0x81, 0xff], u64::MAX.to_be_bytes().to_vec(), vec![0; 4]].concat(),
        vec![0x81, 5, b'h', b'e', b'l', b'l', b'o'],
        vec![0x83, 0x80, 0, 0, 0, 0],
        // The bytes are not valid UTF-8.
        vec![0x81, 0x82, 0, 0, 0, 0, 0xff, 0xfe],
    ];
    attacks.extend((0..40).map(|i| garbage(1 + 37 * i)));
    for attack in attacks {
        let mut socket = server.connect(&origin).unwrap();
        let stream = socket.get_mut();
        let _ = stream.write_all(&attack);
        let _ = stream.shutdown(std::net::Shutdown::Write);
        // The server closes the connection, with or without sending a response.
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        let mut rest = Vec::new();
        let _ = stream.read_to_end(&mut rest);
    }
    // The session of the page is not affected.
    ask(&mut page, serde_json::json!({ "kind": "cast", "origin": [2, 0, 9], "direction": [0, 0, -1], "t_max": null }));
    assert_eq!(wait_for_event(&mut page, "cast")["cast"]["hit"]["object"], 2);
}

#[test]
fn requests_of_any_size_and_form_are_answered() {
    let server = TestServer::new(None);
    let mut page = server.connect(&format!("http://{}", server.host())).unwrap();
    assert_eq!(objects(&mut page, 2), Some(2));
    let deep = "[".repeat(200_000);
    let long = format!("\"{}\"", "a".repeat(4 << 20));
    for message in [
        "",
        "null",
        "[]",
        "{}",
        deep.as_str(),
        long.as_str(),
        r#"{"session":-1,"id":1,"request":{"kind":"outlines"}}"#,
        r#"{"session":1,"id":1e99,"request":{"kind":"outlines"}}"#,
        r#"{"session":1,"id":1,"request":{"kind":"size","width":-1,"height":4}}"#,
        r#"{"session":1,"id":1,"request":{"kind":"crop","crop":[1,2,3]}}"#,
        r#"{"session":1,"id":1,"request":{"kind":"rays","columns":4294967295,"rows":4294967295,"row":null}}"#,
        r#"{"session":1,"id":1,"request":{"kind":"values","left":4294967295,"top":0,"width":4294967295,"height":2}}"#,
        r#"{"session":1,"id":1,"request":{"kind":"explain","x":4294967295,"y":0,"sample":null}}"#,
        r#"{"session":1,"id":1,"request":{"kind":"walk","structure":"tree","origin":[0,0,0],"direction":[0,0,0]}}"#,
        r#"{"session":1,"id":1,"request":{"kind":"options","options":[{"name":"samples","value":"99999999999"}]}}"#,
        r#"{"session":1,"id":1,"request":{"kind":"export","name":"../../etc/passwd"}}"#,
        r#"{"session":1,"id":1,"request":{"kind":"save","force":true}}"#,
    ] {
        page.send(Message::text(message.to_string())).unwrap();
        let why = wait_for_event(&mut page, "refused");
        assert!(why["why"].as_str().is_some_and(|why| why.len() < 1000), "{message:.80}: {why}");
    }
    // The server answers every size and crop, even an invalid one, with a picture.
    for request in [
        r#"{"kind":"size","width":0,"height":0}"#,
        r#"{"kind":"crop","crop":[4294967295,0,0,4294967295]}"#,
        r#"{"kind":"size","width":33,"height":7}"#,
    ] {
        ask(&mut page, serde_json::from_str(request).unwrap());
        wait_for_event(&mut page, "picture");
    }
}

#[test]
fn client_that_does_not_read_blocks_no_one() {
    let server = TestServer::new(None);
    let origin = format!("http://{}", server.host());
    let mut deaf = server.connect(&origin).unwrap();
    assert_eq!(objects(&mut deaf, 5), Some(5));
    // Request megabytes of responses without reading any of them.
    for _ in 0..400 {
        ask(&mut deaf, serde_json::json!({ "kind": "language" }));
    }
    let mut page = server.connect(&origin).unwrap();
    let start = std::time::Instant::now();
    assert_eq!(objects(&mut page, 4), Some(4));
    wait_for_event(&mut page, "picture");
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}

#[test]
fn session_survives_a_thousand_connections() {
    let server = TestServer::new(None);
    let host = format!("Host: {}\r\n", server.host());
    let mut page = server.connect(&format!("http://{}", server.host())).unwrap();
    assert_eq!(objects(&mut page, 6), Some(6));
    let mut held = Vec::new();
    for i in 0..1000 {
        held.extend(TcpStream::connect(server.host()).ok());
        // The system limits the number of connections that a process can have open.
        if held.len() > 200 {
            held.drain(..100);
        }
        if i % 100 == 0 {
            assert_eq!(objects(&mut page, 7 + i), Some(7 + i as u64));
        }
    }
    drop(held);
    assert_eq!(objects(&mut page, 8), Some(8));
    let answered = (0..200).any(|_| {
        std::thread::sleep(Duration::from_millis(20));
        server.get(server.path(), &host).starts_with("HTTP/1.1 200")
    });
    assert!(answered);
}

#[test]
fn idle_connections_block_others_for_a_short_time_only() {
    let server = TestServer::new(None);
    let host = format!("Host: {}\r\n", server.host());
    let idle: Vec<TcpStream> = (0..200).filter_map(|_| TcpStream::connect(server.host()).ok()).collect();
    // The connection is refused, or it is reset before the response arrives.
    assert!(!server.get(server.path(), &host).starts_with("HTTP/1.1 200"));
    drop(idle);
    let answered = (0..100).any(|_| {
        std::thread::sleep(Duration::from_millis(20));
        server.get(server.path(), &host).starts_with("HTTP/1.1 200")
    });
    assert!(answered);
}
