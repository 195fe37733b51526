"""Models over the network, on this machine: pairs with a station's prismesh-intake, pushes a deck, lists it, pulls it back and compares."""
import filecmp
import pathlib
import shutil
import subprocess

from programs import Stop, figures, program, shown, tell, tool

SETTINGS = '[remote]\nlisten = "127.0.0.1:0"\nreserved_gb = 0\n'


def refused(*arguments):
    """Runs what must be refused, and returns the reason."""
    said = subprocess.run([program("prismesh"), *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if said.returncode == 0:
        raise Stop(f"prismesh {arguments[0]} was done, though it had to be refused")
    return said.stderr.strip().splitlines()[-1]


def send_and_fetch(station, deck):
    out = station.out / "remote"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir()
    settings = out / "station.toml"
    settings.write_text(SETTINGS)
    station.start("intake", ["intake", "tokens"], "--config", settings)
    try:
        made = figures("intake", "code")
        paired = figures("pair", made["address"], made["code"], "--name", "demo")
        tell(f"\nremote    paired with a station at {made['address']} by the code {made['code']}, over TLS 1.3")
        pushed = figures("push", deck)
        listed = figures("stations", "models")["models"]
        if [model["model"] for model in listed] != [pushed["model"]]:
            raise Stop(f"the station lists {listed}, not only the model that was pushed")
        tell(f"  pushed {shown(deck)}: {pushed['files']} file(s), {pushed['sent_bytes']} bytes; model {pushed['model'][:12]}")
        pulled = figures("pull", pushed["model"], "-o", out / "back")
        back = pathlib.Path(pulled["main"])
        if not filecmp.cmp(deck, back, shallow=False):
            raise Stop(f"{back} has other bytes than {deck}")
        tell(f"  pulled into {shown(out / 'back')}: the same bytes")
        tool("intake", "revoke", paired["name"])
        reason = refused("stations", "models")
        if "revoked" not in reason:
            raise Stop(f"a revoked token is refused so: {reason}")
        tell("  the token is revoked at the station, and nothing is told any more; docs/remote.md leads through it with two computers")
    finally:
        station.stop("intake")
