"""Options, exit codes, the report, names of files, locales, threads."""
import json
import os
import pty
import subprocess
import sys

import numpy as np

import harness
from harness import check, hole, read, recede, report_of, same_bits, texture, write

COMMANDS = ("fill", "synthesize", "scale-map", "orient")


def pair(folder, name="in.png"):
    return write(folder / name, texture()), write(folder / "mask.png", hole())


def fill(folder, *more, out="out.png", **options):
    image, mask = pair(folder)
    return recede("fill", image, "--mask", mask, "-o", folder / out, *more, **options)


def test_version_and_help(folder):
    check(recede("--version").stdout.startswith(b"recede "))
    check(b"recede fill" in recede("--help").stdout)
    check(recede(code=2).stderr.startswith(b"Usage:"))
    for command in COMMANDS:
        text = recede(command, "--help").stdout.decode()
        for option in ("--slant", "--tilt", "--fov", "--horizon", "--quad", "--frontal", "--json",
                       "--threads", "--memory", "Example:"):
            check(option in text, command, "does not explain", option)


def test_usage_errors_are_2(folder):
    image, mask = pair(folder)
    good = [image, "--mask", mask, "-o", folder / "out.png"]
    wrong = [
        ["--no-such"], ["--slant", "180"], ["--slant", "-1"], ["--slant", "nan"],
        ["--slant", "inf"],
        ["--slant", "4x"], ["--slant", ""], ["--slant=0x10"], ["--slant", " 5"], ["--seed", "0x1"],
        ["--slant", "4,5"], ["--slant", "30", "--tilt", "181"],
        ["--tilt", "20"], ["--fov", "0.5"], ["--fov", "171"], ["--horizon", "1,2,3"],
        ["--horizon", "1,2,1,2"], ["--horizon", "1,2,3,4,5"], ["--quad", "1,2,3,4,5,6,7,8,9"],
        ["--quad", "0,0,1,1,2,2,3,3"], ["--seed", "-1"], ["--seed", "1.5"], ["--threads", "-1"],
        ["--threads", "two"], ["--memory", "0"], ["--memory", "1e3"], ["--method", "magic"],
        ["--quality", "good"], ["--surface", "bumpy"], ["--set", "slant"], ["--set", "none=1"],
        ["--set", "paper-levels=99"], ["--slant"], ["more.png"],
        ["--slant", "30", "--frontal"], ["--horizon", "0,5,60,5", "--slant", "30"],
        ["--quad", "10,10,50,10,60,40,0,40", "--frontal"],
    ]
    for more in wrong[::3 if harness.SANITIZED else 1]:
        done = recede("fill", *good, *more, code=2)
        check(done.stderr.startswith(b"recede: "), more, done.stderr)
    done = recede("fill", *good, "--set", "none=1", code=2)
    check(done.stderr.startswith(b"recede: --set: there is no parameter 'none'"), done.stderr)
    recede("fill", image, "-o", folder / "out.png", code=2)
    recede("fill", image, "--mask", mask, code=2)
    recede("fill", "--mask", mask, "-o", folder / "out.png", code=2)
    recede("synthesize", image, "-o", folder / "out.png", code=2)
    recede("synthesize", image, "--size", "0x5", "-o", folder / "out.png", code=2)
    recede("scale-map", "--size", "9x9", "-o", folder / "out.png", code=2)
    recede("scale-map", image, "--size", "9x9", "--frontal", "-o", folder / "out.png", code=2)
    recede("scale-map", image, "--frontal", "--kind", "up", "-o", folder / "out.png", code=2)
    recede("paint", code=2)
    check(not (folder / "out.png").exists())


def test_input_errors_are_3(folder):
    image, mask = pair(folder)
    out = folder / "out.png"
    options = ["-o", out, "--frontal"]
    masks = {"empty": np.zeros((48, 64), np.uint8), "full": np.full((48, 64), 255, np.uint8),
             "other": hole(40, 64)}
    for name, pixels in masks.items():
        bad = write(folder / f"{name}.png", pixels)
        done = recede("fill", image, "--mask", bad, *options, code=3)
        check(len(done.stderr) > 20, name)
    recede("fill", image, "--mask", mask, "--source", write(folder / "s.png", masks["empty"]),
           *options, code=3)
    recede("fill", folder / "none.png", "--mask", mask, *options, code=3)
    recede("fill", image, "--mask", folder / "none.png", *options, code=3)
    recede("fill", folder, "--mask", mask, *options, code=3)
    (folder / "empty-file.png").write_bytes(b"")
    recede("fill", folder / "empty-file.png", "--mask", mask, *options, code=3)
    check(b"other.png" in recede("fill", image, "--mask", folder / "other.png", *options,
                                 code=3).stderr)
    check(not out.exists())


def test_every_option_is_taken(folder):
    image, mask = pair(folder)
    source = write(folder / "source.png", np.full((48, 64), 255, np.uint8))
    rows = [
        ["--slant", "50"], ["--slant", "50", "--tilt", "-20", "--fov", "60"], ["--frontal"],
        ["--horizon", "0,-20,63,-25"], ["--quad", "10,5,50,5,63,45,0,45"],
        ["--frontal", "--surface", "flat"], ["--frontal", "--surface", "raised"],
        ["--frontal", "--surface", "auto"], ["--frontal", "--quality", "draft"],
        ["--frontal", "--quality", "best"], ["--frontal", "--seed", "2147483647"],
        ["--frontal", "--source", source], ["--frontal", "--set", "engine-iterations=2"],
        ["--frontal", "--memory", "500"], ["--slant=70", "--tilt=0"],
    ]
    for number, more in enumerate(rows):
        recede("fill", image, "--mask", mask, "-o", folder / f"{number}.png", "-q", *more)


def test_report(folder):
    report = json.loads(fill(folder, "--slant", "60", "--tilt", "10", "--json", "-").stdout)
    first = ["version", "method", "orientation", "seed", "threads", "stages", "peak_bytes",
             "output_hash"]
    check(list(report)[:len(first)] == first, list(report))
    orientation = report["orientation"]
    check(list(orientation) == ["slant_deg", "tilt_deg", "fov_deg", "horizon", "confidence",
                                "estimated"], orientation)
    check(abs(orientation["slant_deg"] - 60) < 1e-9 and abs(orientation["tilt_deg"] - 10) < 1e-9)
    check(len(orientation["horizon"]) == 4 and orientation["estimated"] is False)
    check(report["filled_pixels"] == 14 * 20, report["filled_pixels"])
    check(report["peak_bytes"] <= report["estimated_bytes"] * 1.1, report)
    check(all(seconds >= 0 for seconds in report["stages"].values()) and report["stages"])
    check(int(report["output_hash"], 16) >= 0 and len(report["output_hash"]) == 16)


def test_report_to_a_file(folder):
    to = folder / "report.json"
    done = fill(folder, "--frontal", "--json", to)
    check(done.stdout == b"")
    check(json.loads(to.read_text())["orientation"]["horizon"] is None)
    fill(folder, "--frontal", "--json", to, out="two.png", code=4)
    check(not (folder / "two.png").exists(), "filled although the report could not be written")
    fill(folder, "--frontal", "--json", to, "--force", out="two.png")


def test_the_report_replaces_no_picture(folder):
    image, mask = pair(folder)
    source = write(folder / "source.png", np.full((48, 64), 255, np.uint8))
    (folder / "link.png").symlink_to("in.png")
    os.link(mask, folder / "second-name.png")
    before = {path: path.read_bytes() for path in folder.iterdir()}
    for name in ("out.png", "in.png", "mask.png", "source.png", "./out.png", "link.png",
                 "second-name.png", f"../{folder.name}/out.png", f"../{folder.name}/in.png"):
        done = recede("fill", image, "--mask", mask, "--source", source, "-o", folder / "out.png",
                      "--frontal", "--force", "--json", f"{folder}/{name}", code=2)
        check(b"--json names the same file" in done.stderr, name, done.stderr)
    done = recede("orient", image, "--slant", "9", "--json", image, "--force", code=2)
    check(b"--json names the same file as the picture" in done.stderr, done.stderr)
    check({path: path.read_bytes() for path in folder.iterdir()} == before, "a file changed")


def test_a_report_may_replace_a_report(folder):
    image, _ = pair(folder)
    to = folder / "report.json"
    for slant in (20, 30):
        recede("orient", image, "--slant", slant, "--json", to, "--force", "-q")
        check(abs(json.loads(to.read_text())["orientation"]["slant_deg"] - slant) < 1e-9)
    check(b"--force" in recede("orient", image, "--slant", "9", "--json", to, code=4).stderr)


def test_empty_names(folder):
    image, mask = pair(folder)
    out = folder / "out.png"
    good = {"--mask": mask, "-o": out, "--source": mask, "--json": folder / "report.json"}
    for name in good:
        words = [word for pair_ in {**good, name: ""}.items() for word in pair_]
        done = recede("fill", image, *words, "--frontal", code=2)
        check(name.encode() + b": the file's name is empty" in done.stderr, done.stderr)
    recede("orient", "", "--frontal", code=2)
    check(not out.exists())


def test_seed_holds_the_hash(folder):
    image, mask = pair(folder)

    def hash_of(seed, number):
        out = folder / f"{seed}-{number}.png"
        report = report_of("fill", image, "--mask", mask, "-o", out, "--slant", "40", "--seed",
                           seed)
        return report["output_hash"], out.read_bytes()

    check(hash_of(1, 1) == hash_of(1, 2), "the same seed gave two results")
    check(hash_of(1, 3)[0] != hash_of(2, 1)[0], "another seed gave the same result")


def test_locales_give_the_same_bytes(folder):
    image, mask = pair(folder)
    made = set()
    for number, locale in enumerate(("C", "de_DE.UTF-8", "tr_TR.UTF-8", "ar_EG.UTF-8")):
        out = folder / f"{number}.PNG"
        report = report_of("fill", image, "--mask", mask, "-o", out, "--slant", "40.5", "--tilt",
                           "-12.25", environment={"LC_ALL": locale, "LANGUAGE": ""})
        del report["stages"]
        made.add((out.read_bytes(), json.dumps(report)))
    check(len(made) == 1, "the locale changes the output")
    for suffix in ("TIF", "Tiff", "JPG"):
        recede("fill", image, "--mask", mask, "-o", folder / f"x.{suffix}", "--frontal", "-q",
               environment={"LC_ALL": "tr_TR.UTF-8"})


def test_two_runs_write_the_same_bytes(folder):
    for suffix, kind in (("png", "u8"), ("jpg", "u8"), ("tif", "u16"), ("exr", "float")):
        image = write(folder / f"in.{suffix}", texture(kind=kind))
        mask = write(folder / "mask.png", hole())
        files = [folder / f"{run}.{suffix}" for run in "ab"]
        for file in files:
            recede("fill", image, "--mask", mask, "-o", file, "--frontal", "-q")
        check(files[0].read_bytes() == files[1].read_bytes(), suffix, "differs between two runs")


def test_names_of_files(folder):
    names = ["-x.png", "--slant", "with space.png", "new\nline.png", "ünï©ode 日本.png",
             "a;b|c&d.png", "$(touch hit).png", "*.png", "n" * 251 + ".png", "%s%n.png", "-"]
    for number, name in enumerate(names[::3 if harness.SANITIZED else 1]):
        image = write(folder / "plain.png", texture())
        mask = write(folder / "mask.png", hole())
        inside = folder / "sub"
        inside.mkdir(exist_ok=True)
        odd = inside / name
        odd.write_bytes(image.read_bytes())
        out = name if name.endswith(".png") else name + ".png"
        recede("fill", "--mask", mask, "--frontal", "--force", "-q", "-o", f"{number}.png", "--",
               name, folder=inside)
        check(same_bits(read(inside / f"{number}.png")[:10], texture()[:10]), name)
        recede("fill", "--mask", mask, "--frontal", "--force", "-q", f"--output={out}", "--", name,
               folder=inside)
        check(same_bits(read(inside / out)[:10], texture()[:10]), name)
    check(not (folder / "sub" / "hit").exists())
    broken = os.fsencode(folder) + b"/\xff\xfe.png"
    with open(broken, "wb") as file:
        file.write((folder / "plain.png").read_bytes())
    recede("fill", os.fsdecode(broken), "--mask", folder / "mask.png", "--frontal", "-q", "-o",
           folder / "out.png")


def test_messages_stay_one_line(folder):
    done = recede("orient", folder / "a\nb\x1b[31m.png", code=3)
    check(done.stderr.count(b"\n") == 1 and b"\x1b" not in done.stderr, done.stderr)


def test_quiet(folder):
    # The horizon cuts the hole.
    check(b"beyond the horizon" in fill(folder, "--slant", "88").stderr, "no warning")
    check(fill(folder, "--slant", "88", "-q", "--force").stderr == b"")


def test_progress_on_a_terminal_only(folder):
    check(b"%" not in fill(folder, "--frontal").stderr)
    image, mask = pair(folder)
    ours, theirs = pty.openpty()
    run = subprocess.Popen([harness.RECEDE, "fill", image, "--mask", mask, "--frontal", "-o",
                            folder / "two.png"], stderr=theirs)
    os.close(theirs)
    shown = b""
    try:
        while part := os.read(ours, 1000):
            shown += part
    except OSError:  # the terminal's other end is closed
        pass
    os.close(ours)
    check(run.wait(60) == 0)
    check(b"%" in shown and shown.rstrip().endswith(b"\x1b[K"), shown)


def test_orient(folder):
    image = write(folder / "in.png", texture())
    report = report_of("orient", image, "--slant", "30", "--tilt", "5")
    check(abs(report["orientation"]["slant_deg"] - 30) < 1e-9, report)
    check(b"slant 30.0" in recede("orient", image, "--slant", "30").stdout)
    # Estimated: found, or said that it cannot be; never silence.
    done = recede("orient", image, code=None)
    check(done.returncode in (0, 1) and (done.stdout or done.stderr), done)


def test_synthesize(folder):
    image = write(folder / "in.tif", texture(kind="u16"))
    out = folder / "out.tif"
    for method in ("plane", "paper"):
        done = recede("synthesize", image, "--size", "80x56", "--slant", "30", "-o", out, "--force",
                      "--method", method, code=None)
        check(done.returncode in (0, 1), done.stderr)
        if done.returncode == 0:
            pixels = read(out)
            check(pixels.shape == (56, 80, 3) and pixels.dtype == np.uint16, pixels.shape)
            check(pixels.std() > 1000, "a flat result")


def test_an_exemplar_much_larger_than_the_result(folder):
    """Its field of view would be nearly 180 degrees; read from it is the result's orientation."""
    image = write(folder / "in.png", texture(480, 640))
    done = recede("synthesize", image, "--size", "20x15", "-o", folder / "out.png", code=None)
    check(done.returncode == 0 or len(done.stderr) > 20, done)
    check(done.returncode in (0, 1), done)


def test_an_exemplar_seen_from_the_front(folder):
    image = write(folder / "in.png", texture())
    out = folder / "out.png"
    made = {}
    for seen in ("receding", "frontal"):
        recede("synthesize", image, "--size", "120x90", "--slant", "55", "-o", out, "--force",
               "--exemplar", seen)
        made[seen] = read(out).astype(int)
        check(made[seen].shape == (90, 120, 3) and made[seen].std() > 10, seen)
    middle = texture().astype(int)
    check((made["receding"][21:69, 28:92] == middle).all(), "the exemplar is not the middle")
    # Its lower edge lies in the middle of the result's: as wide, and hardly foreshortened.
    below = np.abs(made["frontal"][88, 32:88] - middle[46, 4:60]).mean()
    check(below < 20, "it does not begin below", below)
    for more, word in (((), b"slant"), (("--slant", "50", "--method", "paper"), b"method plane"),
                       (("--slant", "170"), b"horizon")):
        done = recede("synthesize", image, "--size", "120x90", "-o", out, "--force", "--exemplar",
                      "frontal", *more, code=2)
        check(word in done.stderr, more, done.stderr)
    recede("fill", image, "--mask", image, "--exemplar", "frontal", "-o", out, code=2)


def test_an_orientation_set_is_one_given(folder):
    image = write(folder / "in.png", texture())
    done = recede("orient", image, "--set", "slant=30", "--set", "tilt=20")
    check("slant 30.0°, tilt 20.0°".encode() in done.stdout, done.stdout)
    recede("orient", image, "--set", "tilt=20", code=2)


def test_closed_standard_output(folder):
    image, mask = pair(folder)
    reading, writing = os.pipe()
    os.close(reading)
    run = subprocess.run([harness.RECEDE, "fill", image, "--mask", mask, "--frontal", "-q", "-o",
                          folder / "out.png", "--json", "-"], stdout=writing, timeout=60,
                         stderr=subprocess.PIPE, check=False)
    os.close(writing)
    check(run.returncode == 4, run)


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
