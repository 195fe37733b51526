"""The haptic pen: a simulated hand pushes a pen on a sheet, takes a node and pulls it, while the force is recorded."""
import json
import shutil
import subprocess
import time

from programs import ROOT, Stop, edit, program, session, shown, tell, tool

SCRIPT = ROOT / "demo" / "pen.hand"
SETTINGS = '[haptic_pen]\ndriver = "simulated"\nhand_script = {}\nworkspace_scale = 0.3\n'
PICTURES, PACE_S = 14, 1.5
ATTEMPTS = 3
RECORDED_S = 15  # the script's length, and the way to it


class Record:
    """A record of the pen's loop, by column."""

    def __init__(self, file):
        lines = file.read_text().splitlines()
        names = lines[2].split()[1:]
        self.rows = [dict(zip(names, map(float, line.split()))) for line in lines[3:]]
        start = self.rows[0]["now_ns"]
        for row in self.rows:
            row["s"] = (row["now_ns"] - start) * 1e-9
            row["force"] = sum(row[f"newton_{axis}"] ** 2 for axis in "xyz") ** 0.5

    def first(self, holds):
        return next((row["s"] for row in self.rows if holds(row)), None)

    def work_joule(self):
        """What the motors have put into the hand."""
        return sum(
            row[f"newton_{axis}"] * (after[f"position_mm_{axis}"] - row[f"position_mm_{axis}"]) * 1e-3
            for row, after in zip(self.rows, self.rows[1:])
            for axis in "xyz"
        )


class Curve:
    """Force and depth over time as an SVG."""

    WIDTH, HEIGHT, LEFT, BOTTOM, TOP = 900, 320, 60, 40, 30

    def __init__(self, record, marks):
        self.record, self.marks = record, marks
        self.seconds = record.rows[-1]["s"]
        self.newton = max(1.0, max(row["force"] for row in record.rows))

    def x(self, s):
        return self.LEFT + (self.WIDTH - self.LEFT - 20) * s / self.seconds

    def y(self, share):
        return self.HEIGHT - self.BOTTOM - (self.HEIGHT - self.BOTTOM - self.TOP) * share

    def line(self, of, colour):
        points = " ".join(f"{self.x(row['s']):.1f},{self.y(of(row)):.1f}" for row in self.record.rows[::10])
        return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.5"/>'

    def text(self, x, y, words, colour="#333", anchor="start"):
        return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}">{words}</text>'

    def svg(self):
        parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.WIDTH}" height="{self.HEIGHT}" font-family="sans-serif" font-size="13">',
            '<rect width="100%" height="100%" fill="white"/>',
        ]
        for newton in range(int(self.newton) + 1):
            y = self.y(newton / self.newton)
            parts.append(f'<path d="M{self.LEFT} {y:.1f}H{self.WIDTH - 20}" stroke="#ddd"/>' + self.text(self.LEFT - 8, y + 4, f"{newton} N", anchor="end"))
        for second in range(0, int(self.seconds) + 1, 2):
            parts.append(self.text(self.x(second), self.HEIGHT - self.BOTTOM + 18, f"{second} s", anchor="middle"))
        for row, (words, second) in enumerate((words, second) for words, second in self.marks if second is not None):
            x = self.x(second)
            parts.append(f'<path d="M{x:.1f} {self.TOP}V{self.HEIGHT - self.BOTTOM}" stroke="#999" stroke-dasharray="3 3"/>')
            parts.append(self.text(x + 4, self.TOP - 6 + 14 * (row % 2), words))
        low = min(row["position_mm_z"] for row in self.record.rows)
        span = max(row["position_mm_z"] for row in self.record.rows) - low or 1
        parts.append(self.line(lambda row: (row["position_mm_z"] - low) / span, "#5b8fd0"))
        parts.append(self.line(lambda row: row["force"] / self.newton, "#c0392b"))
        parts.append(self.text(self.WIDTH - 24, self.HEIGHT - self.BOTTOM + 34, f"red: force sent; blue: the pen's height, {low:.0f} to {low + span:.0f} mm", anchor="end"))
        return "\n".join([*parts, "</svg>"]) + "\n"


def push_and_pull(station, out, settings):
    """Plays the hand's script once. Returns the record, the edits that were made, and the last that the kiosk said."""
    before = session("state")["generations"]
    kiosk = subprocess.Popen(list(map(str, [program("prismesh-kiosk"), "--profile", "mono-left", "--size", "1200x800", "--trace",
                                            "--headless-frames", PICTURES, "--pace", PACE_S, "--shots", out, "--title", "A simulated pen touches, takes and pulls the sheet"])),
                             stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)  # fmt: skip
    try:
        next((line for line in kiosk.stdout if line.startswith("shot ")), None)
        station.start_pen(settings)
        time.sleep(1)
        tool("devices", "--arm-pen", "--record", out / "pen.record", "--seconds", RECORDED_S)
        trace = kiosk.stdout.read().splitlines()
    finally:
        if kiosk.poll() is None:
            kiosk.kill()
        kiosk.wait()
        station.stop("pen")
    made = [generation["made_by"] for generation in session("state")["generations"][len(before) :]]
    return Record(out / "pen.record"), made, trace[-1] if trace else "nothing"


def feel(station, is_sample):
    """Touches, takes and pulls a sheet with a simulated pen, in the kiosk. Writes pictures, the record and the force curve to pen/."""
    if is_sample:
        edit(edit="only", on="part:6")  # the floor panel: a sheet with beads
    touch_and_take(station, is_sample)
    if is_sample:
        session("undo")


def touch_and_take(station, is_sample):
    out = station.out / "pen"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    settings = out / "pen.toml"
    settings.write_text(SETTINGS.format(json.dumps(str(SCRIPT))))
    tell("\npen       a simulated hand pushes the pen on the sheet, slides, takes the node under it, pulls, and lets go")
    for _ in range(ATTEMPTS):
        record, made, said = push_and_pull(station, out, settings)
        touched = record.first(lambda row: row["element"] >= 0)
        armed = record.first(lambda row: row["phase"] == 1)
        latched = record.first(lambda row: row["phase"] == 2 and armed is not None and armed < row["s"] < RECORDED_S - 1)
        if armed is not None and latched is None:
            break
        tell("  this machine is busy: no pose came for more than 10 ms, so the pen's force went to zero; once more")
        if made:
            session("undo")
    else:
        return tell("  the machine is too busy for a pen; nothing was pulled")
    if touched is None and not is_sample:
        return tell("  nothing of this deck is where the hand pushes")
    if touched is None:
        raise Stop(f"the pen has touched nothing; its record is {out / 'pen.record'}")
    if made != ["move"]:
        raise Stop(f"the pen's grab made the edits {made or 'none'} in place of one move; the kiosk said: {said}")
    marks = [("armed", record.first(lambda row: row["phase"] == 1)), ("touches", touched), ("takes", record.first(lambda row: row["buttons"] == 1)),
             ("lets go", record.first(lambda row: row["s"] > touched + 5 and row["buttons"] == 0 and row["position_mm_z"] > 15))]  # fmt: skip
    (out / "force.svg").write_text(Curve(record, marks).svg())
    replayed = json.loads(tool("devices", "--replay", out / "pen.record", "--json"))
    tell(f"  touches the sheet after {touched:.1f} s; at most {max(row['force'] for row in record.rows):.2f} N; work put into the hand {record.work_joule() * 1e3:+.1f} mJ")
    tell(f"  one edit moved the node; {replayed['forces_compared']:,} forces run again, {replayed['differing']} different")
    tell(f"  {shown(out)}/frame-*.png: what the kiosk shows; force.svg: the force over time; pen.record: each tick")
    session("undo")
