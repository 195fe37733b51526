"""Prismesh's programs as the demo runs them: the command line, and daemons with folders of their own."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BIN = pathlib.Path(os.environ.get("PRISMESH_PROGRAMS", ROOT / "build" / "bin"))


class Stop(Exception):
    """A sentence for the user; the demo ends with it."""


class Refused(Stop):
    """A program did not do what it was asked; the sentence is the program's own reason."""


def tell(text):
    print(text, flush=True)


def shown(path):
    """A path as the user sees it: relative to the project where it is inside."""
    return path.relative_to(ROOT) if path.is_relative_to(ROOT) else path


def program(name):
    path = BIN / name
    if not os.access(path, os.X_OK):
        raise Stop(f"{path} isn't built; ./station demo builds it")
    return path


def tool(*arguments, limit_s=None):
    """Runs prismesh and returns its standard output. After `limit_s` it is interrupted as by Ctrl-C: then nothing is changed."""
    running = subprocess.Popen([program("prismesh"), *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True, errors="replace")  # fmt: skip
    try:
        out, err = running.communicate(timeout=limit_s)
    except subprocess.TimeoutExpired:
        running.send_signal(signal.SIGINT)
        out, err = running.communicate()
        if running.returncode != 0:
            raise Refused(f"stopped, since it was not done after {limit_s:g} s") from None
    except BaseException:
        running.kill()
        raise
    if running.returncode != 0:
        said = err.strip() or out.strip() or "nothing"  # notes first, the reason last
        raise Refused(f"prismesh {arguments[0]} said: {said.splitlines()[-1]}")
    return out


def figures(*arguments):
    """What a command prints with --json, as an object."""
    return json.loads(tool(*arguments, "--json"))


def session(*arguments, limit_s=None):
    """Sends one request to modeld and returns its answer as an object."""
    text = tool("session", *arguments, "--json", limit_s=limit_s)
    return json.loads(text) if text.strip() else {}


def edit(limit_s=None, **what):
    """Applies an edit and returns its report."""
    return session("edit", json.dumps(what), limit_s=limit_s)


class Station:
    """A modeld and a deviced with folders of their own, in the demo's folder."""

    def __init__(self, out):
        self.out = out
        state = out / "state"
        shutil.rmtree(state, ignore_errors=True)  # an earlier demo's journal would be recovered
        runtime = out / "run"
        if len(str(runtime)) > 80:  # a socket's path has room for 107 characters
            runtime = pathlib.Path(tempfile.mkdtemp(prefix="prismesh-demo-"))
        for folder in (state, runtime):
            folder.mkdir(parents=True, exist_ok=True)
            folder.chmod(0o700)
        os.environ["RUNTIME_DIRECTORY"] = str(runtime)
        os.environ["STATE_DIRECTORY"] = str(state)
        os.environ["XDG_CONFIG_HOME"] = str(state)  # the demo's devices are simulated, whatever this machine has
        self.runtime = runtime
        self.processes = {}
        try:
            self.start("modeld", ["session", "state"])
        except BaseException:
            self.end()
            raise

    def start(self, name, question, *arguments, of=None):
        """Starts a daemon and waits until it answers. `of`: its program, if that has another name."""
        log = self.out / f"{name}.log"
        with open(log, "w") as said:
            process = subprocess.Popen([program(f"prismesh-{of or name}"), *arguments], stdin=subprocess.DEVNULL, stdout=said, stderr=said)
        self.processes[name] = process
        for _ in range(150):
            if process.poll() is not None:
                raise Stop(f"{name} ended at once: {log.read_text().strip()}")
            if subprocess.run([program("prismesh"), *question], capture_output=True, stdin=subprocess.DEVNULL).returncode == 0:
                return
            time.sleep(0.1)
        raise Stop(f"{name} doesn't answer; its log is {log}")

    def start_deviced(self):
        self.start("deviced", ["devices"], "--config", ROOT / "demo" / "simulated.toml")

    def start_pen(self, settings):
        self.start("pen", ["devices", "--record", os.devnull, "--seconds", "0"], "--only", "pen", "--config", settings, of="deviced")

    def stop(self, name):
        """Ends a daemon in order."""
        process = self.processes.pop(name, None)
        if process is not None:
            process.terminate()
            process.wait(10)

    def kill(self, name):
        """Ends a daemon like a crash."""
        self.processes[name].kill()
        self.processes[name].wait()

    def end(self):
        for process in self.processes.values():
            if process.poll() is None:
                process.terminate()
        for process in self.processes.values():
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        if self.runtime.parent != self.out:
            shutil.rmtree(self.runtime, ignore_errors=True)
