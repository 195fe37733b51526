"""Tracked stereo with a simulated eye tracker and prism servo, checked by a simulated viewer."""
import shutil
import subprocess

from programs import Stop, program, shown, tell

PICTURES = 5  # while the head moves


class TrackedPicture:
    """One picture of the kiosk, from its trace."""

    def __init__(self, file):
        self.file = file
        self.drawn_for = self.seen_from = None  # (eyes, mask): predicted; and as measured when the picture would have lit up
        self.share = None


def eyes_and_mask(words):
    """From `... eyes X Y Z mask M`."""
    at = words.index("eyes")
    mask = words[words.index("mask") + 1]
    return tuple(float(word) for word in words[at + 1 : at + 4]), None if mask == "none" else float(mask)


def watch_kiosk(station, kiosk, shots):
    """Reads the kiosk's trace to its end and kills deviced after the tracked pictures. Returns the pictures."""
    pictures = {}
    killed = False
    for line in kiosk.stdout:
        words = line.split()
        if not words or words[0] not in ("drawn_for", "seen_from"):
            continue
        picture = pictures.setdefault(words[1], TrackedPicture(shots / words[1]))
        setattr(picture, words[0], eyes_and_mask(words))
        if words[0] == "drawn_for":
            picture.share = float(words[words.index("share") + 1])
        if not killed and sum(1 for p in pictures.values() if p.seen_from) >= PICTURES:
            killed = True
            station.kill("deviced")
    return list(pictures.values())


def look_through_mask(picture):
    """Computes with the simulated viewer what each eye sees of a woven picture, from the true positions of eyes and mask."""
    eyes, mask = picture.seen_from
    seen = {eye: picture.file.with_name(f"{picture.file.stem}-{eye}-eye.png") for eye in ("left", "right")}
    command = [program("prismesh-viewer"), picture.file, "--left", seen["left"], "--right", seen["right"],
               "--eye", ",".join(map(str, eyes)), "--mask", str(mask)]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise Stop(f"prismesh-viewer said: {done.stderr.strip()}")
    return seen


def differing(a, b):
    """Whether the files of two pictures differ."""
    return a.read_bytes() != b.read_bytes()


def track(station):
    """Shows tracked stereo with both simulators, then mono after deviced has died. Writes pictures to tracked/ in the demo's folder."""
    shots = station.out / "tracked"
    shutil.rmtree(shots, ignore_errors=True)
    station.start_deviced()
    tell("\ndeviced   simulates an eye tracker (60 Hz, 1 mm of noise) and a prism servo; the kiosk draws for the predicted head")
    command = [program("prismesh-kiosk"), "--profile", "prism-mask", "--size", "1600x1000", "--headless-frames", PICTURES + 1,
               "--pace", "2", "--shots", shots, "--trace", "--title", "Drawn for the eyes that the simulated tracker sees"]  # fmt: skip
    log = station.out / "kiosk.log"
    with open(log, "w") as said:
        kiosk = subprocess.Popen(list(map(str, command)), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=said, text=True)
        pictures = watch_kiosk(station, kiosk, shots)
        if kiosk.wait() != 0:
            raise Stop(f"the kiosk ended with {kiosk.returncode}: {log.read_text().strip()}")
    tracked = [picture for picture in pictures if picture.seen_from and picture.share > 0]
    if len(tracked) < PICTURES - 1 or pictures[-1].share != 0:
        last = pictures[-1].share if pictures else "none"
        raise Stop(f"{len(tracked)} of {PICTURES} pictures are in depth, and the last, after deviced was killed, has depth {last}")
    for picture in tracked:
        seen = look_through_mask(picture)
        if not differing(seen["left"], seen["right"]):
            raise Stop(f"both eyes see the same in {picture.file.name}, though it was drawn in depth")
        eyes, _ = picture.seen_from
        off = sum((a - b) ** 2 for a, b in zip(eyes, picture.drawn_for[0])) ** 0.5
        tell(f"  {shown(picture.file)}  head at {eyes[0]:+6.1f} {eyes[1]:+6.1f} {eyes[2]:6.1f} mm, predicted to {off:.1f} mm; "
             f"*-left-eye.png and *-right-eye.png: what each eye sees")
    tell(f"  {shown(pictures[-1].file)}  after deviced was killed: mono")
