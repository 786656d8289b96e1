"""Compares the daylight of a year in a room with Radiance's tools: `cargo xtask peers --daylight`.

Both programs read the same room (a Radiance scene) and the same weather, which is made by a formula. Radiance computes
daylight coefficients of Reinhart's 2305 patches with `rfluxmtx` and the skies with `gendaymtx`. Its direct sunlight comes
from the real positions of the sun, as in the method of Subramaniam, Daylighting Simulations with Radiance using
Matrix-based Methods, 2017: the direct part of the sunlight in the patches is replaced by shadow rays to the suns of
`gendaymtx -D`. A second comparison traces a few hours with `rtrace`, each under its own sky of `gendaylit`.

    python daylight.py DURER [--table FILE] [--fast]
"""

import datetime
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pyradiance

BIN = Path(pyradiance.__file__).parent / "bin"
os.environ["PATH"] = f"{BIN}:{os.environ['PATH']}"
os.environ["RAYPATH"] = f".:{Path(pyradiance.__file__).parent / 'lib'}"
LATITUDE, LONGITUDE, ZONE = 47.5, 8.5, 1.0
EFFICACY = 179.0
WEIGHTS = np.array([0.265, 0.670, 0.065])

# A room of 4 m x 6 m x 3 m with a glazed window in its south wall, and an overhang.
ROOM = """
void plastic floor 0 0 5 0.2 0.2 0.2 0 0
void plastic wall 0 0 5 0.5 0.5 0.5 0 0
void plastic ceiling 0 0 5 0.7 0.7 0.7 0 0
void glass pane 0 0 3 0.88 0.88 0.88
floor polygon p1 0 0 12 0 0 0 4 0 0 4 6 0 0 6 0
ceiling polygon p2 0 0 12 0 0 3 0 6 3 4 6 3 4 0 3
wall polygon p3 0 0 12 0 0 0 0 6 0 0 6 3 0 0 3
wall polygon p4 0 0 12 4 0 0 4 0 3 4 6 3 4 6 0
wall polygon p5 0 0 12 0 6 0 4 6 0 4 6 3 0 6 3
wall polygon p6 0 0 12 0 0 0 0 0 0.9 4 0 0.9 4 0 0
wall polygon p7 0 0 12 0 0 2.4 0 0 3 4 0 3 4 0 2.4
wall polygon p8 0 0 12 0 0 0.9 0 0 2.4 0.5 0 2.4 0.5 0 0.9
wall polygon p9 0 0 12 3.5 0 0.9 3.5 0 2.4 4 0 2.4 4 0 0.9
wall polygon p10 0 0 12 0 0 2.6 4 0 2.6 4 -0.5 2.6 0 -0.5 2.6
pane polygon p11 0 0 12 0.5 0 0.9 0.5 0 2.4 3.5 0 2.4 3.5 0 0.9
"""
SENSORS = [(x, y, 0.8) for y in (0.8, 2.4, 5.0) for x in (0.8, 2.0, 3.2)]


def weather():
    """Returns rows of month, day, hour, direct normal and diffuse horizontal irradiance for a year."""
    rows, day = [], 0
    for month, days in enumerate([31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31], 1):
        for date in range(1, days + 1):
            cloud = (math.sin(12.9898 * day) * 43758.5453) % 1.0
            declination = math.radians(23.45) * math.sin(2 * math.pi * (day - 80) / 365)
            for hour in range(24):
                angle = math.radians(15 * (hour + 0.5 - 12 + LONGITUDE / 15 - ZONE))
                latitude = math.radians(LATITUDE)
                sine = math.sin(latitude) * math.sin(declination)
                sine += math.cos(latitude) * math.cos(declination) * math.cos(angle)
                direct = diffuse = 0.0
                if sine > 0.02:
                    direct = (1 - cloud) ** 1.5 * 950 * math.exp(-0.12 / sine)
                    diffuse = sine * (90 + 330 * cloud * (1 - 0.5 * cloud))
                rows.append((month, date, hour + 0.5, round(direct), round(diffuse)))
            day += 1
    return rows


def write_weather(rows, folder):
    header = f"place Formula\nlatitude {LATITUDE}\nlongitude {-LONGITUDE}\ntime_zone {-15 * ZONE}\nsite_elevation 400\n"
    text = header + "weather_data_file_units 1\n" + "".join("%d %d %.3f %d %d\n" % row for row in rows)
    (folder / "year.wea").write_text(text)
    lines = [f"LOCATION,Formula,-,-,Formula,0,{LATITUDE},{LONGITUDE},{ZONE},400", "DESIGN CONDITIONS,0"]
    lines += ["TYPICAL/EXTREME PERIODS,0", "GROUND TEMPERATURES,0", "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0", "COMMENTS 1,"]
    lines += ["COMMENTS 2,", "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31"]
    for month, day, hour, direct, diffuse in rows:
        # The dew point is that of gendaymtx.
        lines.append(f"2001,{month},{day},{int(hour + 0.5)},60,?,15,11,50,96000,0,0,300,0,{direct},{diffuse},0,0,0,0")
    (folder / "year.epw").write_text("\n".join(lines) + "\n")


def run(command, folder, text=None):
    done = subprocess.run(command, cwd=folder, input=text, capture_output=True, check=False)
    if done.returncode:
        sys.exit(f"{command}: {done.stderr.decode()[-2000:]}")
    return done.stdout


def matrix(data):
    """Reads a binary Radiance matrix of RGB doubles or floats, and returns its luminous values."""
    head, body = data.split(b"\n\n", 1)
    columns = int(re.search(rb"NCOLS=\s*(\d+)", head).group(1))
    kind = np.float64 if b"FORMAT=double" in head else np.float32
    values = np.frombuffer(body, dtype=kind).reshape(-1, columns, 3)
    return values.astype(np.float64) @ WEIGHTS


def to_sun(month, day, hour):
    """Returns the direction to the sun in 2001, x east and y north, by the Astronomical Almanac's low precision formulas.

    gendaymtx computes it without the year, by a simpler formula that differs by up to half a degree.
    """
    n = (datetime.datetime(2001, month, day) - datetime.datetime(2000, 1, 1)).days - 0.5 + (hour - ZONE) / 24
    mean, anomaly = 280.460 + 0.9856474 * n, math.radians(357.528 + 0.9856003 * n)
    along = math.radians(mean + 1.915 * math.sin(anomaly) + 0.020 * math.sin(2 * anomaly))
    lean = math.radians(23.439 - 0.0000004 * n)
    x, y, z = math.cos(along), math.cos(lean) * math.sin(along), math.sin(lean) * math.sin(along)
    turn = math.radians(15 * (6.697375 + 0.0657098242 * n + hour - ZONE) + LONGITUDE)
    south, east = x * math.cos(turn) + y * math.sin(turn), y * math.cos(turn) - x * math.sin(turn)
    sine, cosine = math.sin(math.radians(LATITUDE)), math.cos(math.radians(LATITUDE))
    return east, cosine * z - sine * south, sine * z + cosine * south


def suns(folder):
    """Returns the directions of the suns of a year by the minute of the year, from the file of gendaymtx."""
    text = (folder / "suns.rad").read_text()
    pattern = r"void light solar(\d+)\s+0\s+0\s+3 (\S+) .*?source sun\1\s+0\s+0\s+4 (\S+) (\S+) (\S+) (\S+)"
    return {int(found[0]): [float(word) for word in found[1:]] for found in re.findall(pattern, text, re.S)}


def radiance_year(folder, rows, fast):
    """Returns the illuminances of all rows and sensors by Radiance."""
    (folder / "room.rad").write_text(ROOM)
    black = re.sub(r"plastic (\w+) 0 0 5 .*", r"plastic \1 0 0 5 0 0 0 0 0", ROOM)
    (folder / "black.rad").write_text(black)
    sky = "void glow {0} 0 0 4 1 1 1 0\n{0} source {0}s 0 0 4 0 0 {1} 180\n"
    (folder / "sky.rad").write_text(
        "#@rfluxmtx h=u u=Y\n" + sky.format("ground", -1) + "#@rfluxmtx h=r4 u=Y\n" + sky.format("dome", 1)
    )
    points = "".join("%g %g %g 0 0 1\n" % point for point in SENSORS).encode()
    count = "4000" if fast else "300000"
    options = ["-I+", "-ab", "8", "-ad", count, "-lw", "2e-7", "-n", "2", "-w-"]
    flux = lambda room, more: matrix(run([BIN / "rfluxmtx", *options, *more, "-faf", "-", "sky.rad", room], folder, points))
    start = time.time()
    whole = flux("room.rad", [])
    print(f"rfluxmtx: {time.time() - start:.0f} s", file=sys.stderr)
    direct = flux("black.rad", ["-ab", "1"])
    by_row = direct_sun(folder, rows, points)
    day = lambda *more: matrix(run([BIN / "gendaymtx", "-m", "4", "-c", "1", "1", "1", "-of", *more, "year.wea"], folder))
    skies, sun_patches = day(), day("-d")
    return EFFICACY * (whole @ skies - direct @ sun_patches + by_row)


def direct_sun(folder, rows, points):
    """Returns the irradiances of all sensors and rows by direct sunlight, from the real positions of the sun."""
    run([BIN / "gendaymtx", "-m", "1", "-u", "-D", "suns.rad", "-M", "suns.mod", "-of", "year.wea"], folder)
    strength = suns(folder)
    lights = [(minute, *to_sun(*rows[minute // 60][:3])) for minute in strength]
    light = "void light s{0} 0 0 3 1 1 1\ns{0} source d{0} 0 0 4 {1:.7f} {2:.7f} {3:.7f} 0.533\n"
    (folder / "suns.rad").write_text("".join(light.format(*one) for one in lights))
    (folder / "suns.mod").write_text("".join(f"s{minute}\n" for minute, *_ in lights))
    octree = run([BIN / "oconv", "black.rad", "suns.rad"], folder)
    (folder / "suns.oct").write_bytes(octree)
    start = time.time()
    exact = run(
        [BIN / "rcontrib", "-I+", "-ab", "0", "-dc", "1", "-dt", "0", "-dj", "1", "-dr", "0", "-h+", "-faf", "-M", "suns.mod", "suns.oct"],
        folder,
        points,
    )
    print(f"rcontrib to the suns: {time.time() - start:.0f} s", file=sys.stderr)
    exact = np.frombuffer(exact.split(b"\n\n", 1)[1], dtype=np.float32).reshape(len(SENSORS), len(lights), 3) @ WEIGHTS
    by_row = np.zeros((len(SENSORS), len(rows)))
    for column, (minute, *_) in enumerate(lights):
        by_row[:, minute // 60] = exact[:, column] * strength[minute][0]
    return by_row


def radiance_hour(folder, row, fast):
    """Returns the illuminances of the sensors in one hour, with the sky of gendaylit and `rtrace`."""
    month, day, hour, direct, diffuse = row
    x, y, z = to_sun(month, day, hour)
    altitude, azimuth = math.degrees(math.asin(z)), math.degrees(math.atan2(-x, -y))
    angles = ["-ang", f"{altitude:.5f}", f"{azimuth:.5f}"]
    sky = run([BIN / "gendaylit", *angles, "-W", str(direct), str(diffuse), "-g", "0.2"], folder).decode()
    sky += "\nskyfunc glow g 0 0 4 1 1 1 0\ng source s1 0 0 4 0 0 1 180\ng source s2 0 0 4 0 0 -1 180\n"
    (folder / "hour.rad").write_text(sky)
    (folder / "hour.oct").write_bytes(run([BIN / "oconv", "hour.rad", "room.rad"], folder))
    points = "".join("%g %g %g 0 0 1\n" % point for point in SENSORS).encode()
    count = "2000" if fast else "16000"
    options = ["-I+", "-h", "-ab", "7", "-aa", "0", "-ad", count, "-as", "0", "-lw", "1e-6", "-dj", "0.9", "-ds", "0.05", "-dt", "0"]
    lines = run([BIN / "rtrace", *options, "-n", "2", "hour.oct"], folder, points).decode().split("\n")
    return EFFICACY * np.array([[float(word) for word in line.split()] for line in lines if line.strip()]) @ WEIGHTS


def durer_year(durer, folder, fast):
    places = [word for x, y, z in SENSORS for word in ("--at", f"{x},{y},{z}")]
    samples = "4096" if fast else "65536"
    common = [durer, "measure", "room.rad", "--weather", "year.epw", *places, "--quiet"]
    start = time.time()
    text = run([*common, "--samples", samples, "--hours", "hours.csv", "--json", "--patches", "2305"], folder)
    print(f"durer: {time.time() - start:.0f} s", file=sys.stderr)
    table = np.genfromtxt(folder / "hours.csv", delimiter=",", skip_header=1)
    return json.loads(text), table[:, 4::2].T


def durer_hour(durer, folder, row, fast):
    month, day, hour, *_ = row
    places = [word for x, y, z in SENSORS for word in ("--at", f"{x},{y},{z}")]
    when = f"{month}-{day}T{int(hour)}:{round(60 * (hour % 1)):02d}"
    samples = "4096" if fast else "65536"
    command = [durer, "measure", "room.rad", "--weather", "year.epw", "--sky-hour", when, *places, "--quiet"]
    lines = run([*command, "--samples", samples], folder).decode().strip().split("\n")[1:]
    return np.array([[float(word) for word in line.split(",")[6:8]] for line in lines]).T


def figures(rows, lux):
    """Returns DA 300, UDI 100-3000 and the mean of each sensor over 8 to 18 o'clock."""
    used = lux[:, [8 < row[2] < 18 for row in rows]]
    useful = ((used >= 100) & (used <= 3000)).mean(axis=1)
    return (used >= 300).mean(axis=1), useful, used.mean(axis=1)


def main():
    durer, fast = os.path.abspath(sys.argv[1]), "--fast" in sys.argv
    table = sys.argv[sys.argv.index("--table") + 1] if "--table" in sys.argv else None
    with tempfile.TemporaryDirectory() as name:
        folder, rows = Path(name), weather()
        write_weather(rows, folder)
        theirs = radiance_year(folder, rows, fast)
        found, ours = durer_year(durer, folder, fast)
        out = []
        lit = theirs.mean(axis=0) > 1.0
        out.append(f"{lit.sum()} hours of the year have daylight.")
        out.append("")
        out.append("| sensor | mean, Radiance | mean, Dürer | ratio | RMS difference of the hours | DA 300: Radiance | Dürer | UDI 100–3000: Radiance | Dürer |")
        out.append("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
        autonomy, useful, _ = figures(rows, theirs)
        for i, place in enumerate(SENSORS):
            a, b, point = theirs[i, lit], ours[i, lit], found["points"][i]
            rms = np.sqrt(np.mean((b - a) ** 2)) / a.mean()
            out.append(
                "| %g, %g, %g | %.1f lx | %.1f ± %.1f lx | %.4f | %.1f %% | %.2f %% | %.2f ± %.2f %% | %.2f %% | %.2f %% |"
                % (*place, a.mean(), b.mean(), point["errors"]["mean"], b.mean() / a.mean(), 100 * rms, 100 * autonomy[i],
                   100 * point["autonomy"], 100 * point["errors"]["autonomy"], 100 * useful[i], 100 * sum(point["useful"][1:3]))
            )
        share = (autonomy >= 0.5).mean(), np.mean([point["autonomy"] >= 0.5 for point in found["points"]])
        out += ["", "sDA 300/50%% of the nine sensors: %.1f %% by Radiance, %.1f %% by Dürer." % (100 * share[0], 100 * share[1])]
        ratio = ours[:, lit].sum() / theirs[:, lit].sum()
        rms = np.sqrt(np.mean((ours[:, lit] - theirs[:, lit]) ** 2)) / theirs[:, lit].mean()
        difference, usual = ours[:, lit] - theirs[:, lit], theirs[:, lit].mean()
        median = np.median(np.abs(difference / np.maximum(theirs[:, lit], 1e-9)))
        edge = np.abs(difference) > 2000
        rest = np.sqrt(np.mean(difference[~edge] ** 2)) / usual
        out += ["", f"All hours and sensors: mean ratio {ratio:.4f}, median difference {100 * median:.2f} %, RMS difference "
                f"{100 * rms:.1f} % of the mean. Without the {100 * edge.mean():.2f} % of the values that differ by more than 2000 lx, "
                f"it is {100 * rest:.1f} %.", ""]
        out.append("| hour | sensors | Radiance | Dürer, of the year | Dürer, --sky-hour |")
        out.append("| --- | --- | ---: | ---: | ---: |")
        chosen = [row for row in rows if (row[0], row[1], row[2]) in
                  {(1, 15, 12.5), (2, 20, 10.5), (3, 21, 14.5), (4, 12, 8.5), (6, 21, 12.5), (8, 3, 16.5), (10, 10, 11.5), (12, 21, 13.5)}]
        for row in chosen:
            index = rows.index(row)
            reference = radiance_hour(folder, row, fast)
            hour, noise = durer_hour(durer, folder, row, fast)
            out.append("| %d-%d %02d:30, %d + %d W/m² | mean of 9 | %.1f lx | %.4f | %.4f |" % (
                row[0], row[1], int(row[2]), row[3], row[4], reference.mean(), ours[:, index].mean() / reference.mean(),
                hour.mean() / reference.mean()))
        text = "\n".join(out) + "\n"
        print(text)
        if table:
            Path(table).write_text(text)


if __name__ == "__main__":
    main()
