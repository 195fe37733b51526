"""A virtual machine that boots the station's disk, and the hands, eyes and tools of a test on it (QEMU by emulation).

The guest has a virtio graphics card with one monitor, a tablet and a keyboard, the two devices on USB serial adapters, and a port for the
test's shell (agent.sh). The firmware takes what arrives on a plain serial port for keys, so only the console is one. Everything that a test
sees of the screen is what the monitor shows."""
import json
import os
import socket
import subprocess
import threading
import time


class Gone(Exception):
    """The machine has ended, or hasn't answered in time."""


class Machine:
    def __init__(self, folder, disk, boot=(), size=(1280, 720), snapshot=True, devices=(None, None), memory_mb=2048, processors=2, log=None, more=()):
        """boot: further QEMU arguments, for example a kernel. devices: for the two adapters, the path of a pseudo-terminal or None. more: QEMU arguments that
        need the USB bus."""
        self.folder = str(folder)
        os.makedirs(self.folder, exist_ok=True)
        self.console_text = []
        self.log = log or (lambda text: None)
        self.began = time.time()
        self.size = size
        for name in ("qmp", "shell"):
            if os.path.exists(self.path(name)):
                os.unlink(self.path(name))
        # QEMU 7.2 reads through masked-off lanes of AVX2's gather, which ends software drawing with a fault.
        arguments = ["qemu-system-x86_64", "-machine", "q35", "-accel", "tcg,thread=multi", "-cpu", "max,avx2=off,avx=off", "-smp", str(processors), "-m", str(memory_mb),
                     "-nodefaults", "-no-reboot", "-display", "none", *boot,
                     "-drive", f"file={disk},format=raw,if=virtio,cache=writethrough" + (",snapshot=on" if snapshot else ""),
                     "-device", f"virtio-vga,xres={size[0]},yres={size[1]},edid=on",
                     "-device", "qemu-xhci", "-device", "usb-tablet", "-device", "usb-kbd",
                     "-qmp", f"unix:{self.path('qmp')},server=on,wait=off",
                     "-serial", "stdio", "-device", "virtio-serial-pci",
                     "-chardev", f"socket,id=shell,path={self.path('shell')},server=on,wait=off",
                     "-device", "virtserialport,chardev=shell,name=prismesh.test"]
        for number, device in enumerate(devices):
            if device:
                arguments += ["-chardev", f"serial,id=line{number},path={device}", "-device", f"usb-serial,chardev=line{number},serial=T{number}"]
        arguments += more
        self.process = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        threading.Thread(target=self._read_console, daemon=True).start()
        self.qmp = self._connect("qmp").makefile("rw")
        try:
            self.qmp.readline()
            self.command("qmp_capabilities")
        except OSError:
            self.process.wait(10)
            raise Gone("QEMU ended at once:\n" + "".join(self.console_text)) from None
        self.shell = self._connect("shell")
        self.said = b""

    def path(self, name):
        return os.path.join(self.folder, name)

    def seconds(self):
        return time.time() - self.began

    def _connect(self, name):
        for _ in range(200):
            try:
                link = socket.socket(socket.AF_UNIX)
                link.connect(self.path(name))
                return link
            except OSError:
                if self.process.poll() is not None:
                    raise Gone("QEMU ended at once:\n" + "".join(self.console_text))
                time.sleep(0.05)
        raise Gone(f"QEMU offers no {name}")

    def _read_console(self):
        for line in self.process.stdout:
            text = line.decode(errors="replace")
            self.console_text.append(text)
            self.log(f"{self.seconds():6.1f} {text.rstrip()}")

    def command(self, name, **arguments):
        self.qmp.write(json.dumps({"execute": name, "arguments": arguments}) + "\n")
        self.qmp.flush()
        while True:
            line = self.qmp.readline()
            if not line:
                raise Gone("the machine is gone")
            answer = json.loads(line)
            if "error" in answer:
                raise Gone(f"QEMU refuses {name}: {answer['error']['desc']}")
            if "return" in answer:
                return answer["return"]

    # --- the shell in the guest ---

    def run(self, command, limit=60, check=True):
        """Runs a line of bash as root. Returns what it wrote. Raises Gone after `limit` seconds, or if it fails and that is checked."""
        mark = f"<<{time.monotonic_ns()}>>"
        self.said = b""
        self.shell.settimeout(1)
        try:
            self.shell.sendall((command.replace("\n", ";") + f" #{mark}\n").encode())
        except TimeoutError:
            raise Gone("the guest's port is full of commands that nobody has read") from None
        end = time.time() + limit
        while time.time() < end:
            if self.process.poll() is not None:
                raise Gone("the machine has ended")
            try:
                self.said += self.shell.recv(65536)
            except TimeoutError:
                continue
            at = self.said.find(mark.encode() + b"=")
            if at >= 0 and b"\n" in self.said[at:]:
                text = self.said[:at].decode(errors="replace").replace("\r", "")
                status = int(self.said[at + len(mark) + 1:].split(b"\n")[0])
                if check and status != 0:
                    raise Gone(f"in the guest, {command!r} fails with {status}:\n{text}")
                return text if check else (status, text)
        raise Gone(f"in the guest, {command!r} takes longer than {limit} s; it wrote {self.said.decode(errors='replace')!r}")

    def wait_for_shell(self, limit=900):
        end = time.time() + limit
        while time.time() < end:
            try:
                return self.run("true", limit=3)
            except Gone:
                if self.process.poll() is not None:
                    raise
        raise Gone("the guest offers no shell: it hasn't booted")

    def wait_until(self, command, limit=60):
        """Waits until the command succeeds in the guest. Returns the machine's seconds."""
        end = time.time() + limit
        while True:
            status, text = self.run(command, check=False, limit=limit)
            if status == 0:
                return self.seconds()
            if time.time() > end:
                raise Gone(f"in the guest, {command!r} doesn't succeed within {limit} s:\n{text}")
            time.sleep(0.2)

    # --- screen and hands ---

    def screen(self, name):
        """Writes what the monitor shows as NAME.ppm, and returns the path."""
        path = self.path(name + ".ppm")
        self.command("screendump", filename=path)
        return path

    def _send(self, *events):
        self.command("input-send-event", events=list(events))

    def move(self, x, y):
        """To a pixel of the picture."""
        # A tablet counts from 0 to 32767 over the screen.
        for axis, at, size in (("x", x, self.size[0]), ("y", y, self.size[1])):
            self._send({"type": "abs", "data": {"axis": axis, "value": round((at + 0.5) * 32768 / size)}})

    def button(self, down, button="left"):
        self._send({"type": "btn", "data": {"down": down, "button": button}})

    def click(self, x, y, button="left"):
        self.move(x, y)
        time.sleep(0.3)
        self.button(True, button)
        time.sleep(0.3)
        self.button(False, button)

    def key(self, *codes):
        """Presses keys together, by QEMU's names, for example "ctrl", "s"."""
        for code in codes:
            self._send({"type": "key", "data": {"down": True, "key": {"type": "qcode", "data": code}}})
        time.sleep(0.1)
        for code in reversed(codes):
            self._send({"type": "key", "data": {"down": False, "key": {"type": "qcode", "data": code}}})

    # --- the end ---

    def kill(self):
        """As pulling the plug out."""
        self.process.kill()
        self.process.wait()

    def power_off(self, limit=60):
        self.command("system_powerdown")
        try:
            self.process.wait(limit)
        except subprocess.TimeoutExpired:
            self.kill()
            raise Gone("the machine doesn't power off")
