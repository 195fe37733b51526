#!/usr/bin/env python3
"""Audits the tree of an image's root against the list of what a station may have. Usage: audit.py TREE LIST. Prints each fault in a line and
ends with status 1 if there is one.

The list (scripts/image/allowed.txt) has a section for each kind of right; a line is what is allowed, after # why. What the image has beyond it
is a fault. So is what the list names and the image no longer has: a list that says too much hides the next fault. Reads files only, so it
works on any tree, and as any user who can read it. users.conf beside the list has the numbers of users and groups."""
import os
import pathlib
import re
import stat
import sys

KINDS = ("listening", "setuid", "writable", "shell", "unit", "setting", "module")
UNIT_FOLDERS = ("etc/systemd/system", "usr/local/lib/systemd/system", "usr/lib/systemd/system", "lib/systemd/system")
# Names of services that give a login or a shell, whatever else the list says.
LOGINS = re.compile(r"^(serial-|console-|container-)?getty(@.*)?\.(service|target)$|^(autovt@.*|debug-shell|sshd?|rlogin|telnet.*)\.(service|socket)$")


def read_list(path):
    allowed, kind = {each: {} for each in KINDS}, None
    for number, line in enumerate(pathlib.Path(path).read_text().splitlines(), 1):
        text, _, why = (part.strip() for part in line.partition("#"))
        if not text:
            continue
        if text.startswith("["):
            kind = text.strip("[]")
            if kind not in allowed:
                raise SystemExit(f"{path}:{number}: there is no kind '{kind}'; the kinds are {', '.join(KINDS)}")
        elif kind is None:
            raise SystemExit(f"{path}:{number}: '{text}' stands before the first section")
        elif not why:
            raise SystemExit(f"{path}:{number}: '{text}' has no reason")
        else:
            allowed[kind][text] = number
    return allowed


class Tree:
    def __init__(self, root):
        self.root = pathlib.Path(root)

    def resolve(self, path, depth=0):
        """The file that a path of the image means: links lead inside the image. None if it isn't there."""
        at = self.root
        parts = [part for part in str(path).split("/") if part not in ("", ".")]
        for index, part in enumerate(parts):
            at = at.parent if part == ".." and at != self.root else at / part
            if at.is_symlink():
                if depth > 20:
                    return None
                target = os.readlink(at)
                base = "" if target.startswith("/") else str(at.parent.relative_to(self.root))
                return self.resolve("/".join([base, target, *parts[index + 1:]]), depth + 1)
            if not os.path.lexists(at):
                return None
        return at

    def text(self, path):
        found = self.resolve(path)
        return found.read_text(errors="replace") if found and found.is_file() else ""

    def files(self):
        """Each file and folder with its state, and its path in the image."""
        for folder, folders, names in os.walk(self.root):
            for name in sorted(folders) + sorted(names):
                path = pathlib.Path(folder, name)
                yield path, "/" + str(path.relative_to(self.root)), path.lstat()

    def unit_names(self):
        names = set()
        for folder in UNIT_FOLDERS:
            found = self.resolve(folder)
            if found and found.is_dir():
                names |= {each.name for each in found.iterdir() if not each.name.endswith((".wants", ".requires", ".d"))}
        return names

    def unit(self, name):
        """A unit's text with its drop-ins; None if it is masked or isn't there. An instance has its template's."""
        template = re.sub(r"@[^.]+\.", "@.", name)
        text = self._unit(name)
        return self._unit(template) if text is None and template != name and not self.is_masked(name) else text

    def is_masked(self, name):
        return any((self.root / folder / name).is_symlink() and os.readlink(self.root / folder / name) == "/dev/null" for folder in UNIT_FOLDERS)

    def _unit(self, name):
        for folder in UNIT_FOLDERS:
            at = self.root / folder / name
            if not os.path.lexists(at):
                continue
            if at.is_symlink() and os.readlink(at) == "/dev/null":
                return None
            text = self.text(f"{folder}/{name}")
            for drop_ins in UNIT_FOLDERS:
                found = self.resolve(f"{drop_ins}/{name}.d")
                if found and found.is_dir():
                    text += "".join(each.read_text() for each in sorted(found.glob("*.conf")))
            return text
        return None

    def wanted(self):
        """The units that start with the machine: what the default target wants and requires, and what those do."""
        start = {"default.target", "sysinit.target", "basic.target", "multi-user.target", "graphical.target", "sockets.target", "timers.target"}
        seen, todo = set(), list(start)
        while todo:
            name = todo.pop()
            if name in seen:
                continue
            seen.add(name)
            text = self.unit(name)
            if text is None and name not in start:
                continue
            for line in re.findall(r"^(?:Wants|Requires|BindsTo|Upholds)=(.*)$", text or "", re.M):
                todo += line.split()
            template = re.sub(r"@[^.]*\.", "@.", name)
            for folder in UNIT_FOLDERS:
                for kind in ("wants", "requires", "upholds"):
                    for base in {name, template}:
                        found = self.resolve(f"{folder}/{base}.{kind}")
                        if found and found.is_dir():
                            todo += [each.name for each in found.iterdir()]
        return {name for name in seen if self.unit(name) is not None}


def listening(tree):
    """Sockets of the network that units open: a port, an address, or a socket that isn't a path of this machine."""
    for name in sorted(tree.wanted()):
        if name.endswith(".socket"):
            for value in re.findall(r"^Listen(?:Stream|Datagram|SequentialPacket)=(.+)$", tree.unit(name), re.M):
                if not value.strip().startswith(("/", "@", "%t/")):
                    yield f"{name} {value.strip()}", f"{name} listens on {value.strip()}"


def services(tree):
    """Services that start with the machine and may use the network's addresses."""
    for name in sorted(tree.wanted()):
        if name.endswith(".service"):
            yield name, f"{name} starts with the machine"


def rights(tree):
    for path, name, state in tree.files():
        if stat.S_ISREG(state.st_mode) and state.st_mode & 0o6000:
            yield "setuid", name, f"{name} runs with the rights of its owner or group"
        if not stat.S_ISLNK(state.st_mode) and state.st_mode & 0o002 and not stat.S_ISCHR(state.st_mode):
            yield "writable", name, f"{name} can be written by everybody"


def shells(tree):
    good = {line.strip() for line in tree.text("etc/shells").splitlines() if line.startswith("/")} | {"/bin/sh", "/bin/bash", ""}
    for line in tree.text("etc/passwd").splitlines():
        fields = line.split(":")
        if len(fields) == 7 and fields[6] in good:
            yield fields[0], f"the user {fields[0]} has the shell {fields[6] or '/bin/sh'}"


def passwords(tree):
    for line in tree.text("etc/shadow").splitlines():
        fields = line.split(":")
        if len(fields) > 1 and not fields[1].startswith(("!", "*")):
            yield f"the user {fields[0]} can log in with a password" + ("" if fields[1] else ", an empty one")


def identity(tree):
    """What each station must make for itself."""
    if tree.text("etc/machine-id").strip() not in ("", "uninitialized"):
        yield "/etc/machine-id is in the image: all stations would be one"
    if tree.resolve("etc/hostname"):
        yield "/etc/hostname is in the image: all stations would have one name"
    for path, name, state in tree.files():
        if not stat.S_ISREG(state.st_mode):
            continue
        if re.search(r"/ssh_host_.*key$|/random-seed$", name):
            yield f"{name} is in the image: all stations would share it"
        elif state.st_size < 20000 and re.search(r"\.(key|pem|p12)$|/id_[a-z0-9]+$|authorized_keys", name):
            text = path.read_bytes()
            if b"PRIVATE KEY" in text:
                yield f"{name} is a private key in the image" + (", and everybody can read it" if state.st_mode & 0o004 else "")
            elif name.endswith("authorized_keys") and text.strip():
                yield f"{name} lets somebody into every station"


def logins(tree):
    for name in sorted(tree.wanted()):
        if LOGINS.match(name):
            yield f"{name} starts with the machine: it gives a login"
    for name in ("getty@.service", "serial-getty@.service", "autovt@.service", "debug-shell.service"):
        if tree.unit(name) is not None:
            yield f"{name} isn't masked: it gives a login when something asks for it"
    for generator in ("systemd-getty-generator", "systemd-debug-generator"):
        there = any(tree.resolve(f"{folder}/{generator}") for folder in ("usr/lib/systemd/system-generators", "lib/systemd/system-generators"))
        mask = tree.root / "etc/systemd/system-generators" / generator
        if there and not (mask.is_symlink() and os.readlink(mask) == "/dev/null"):
            yield f"{generator} isn't masked: it makes logins of the kernel's command line"


def sysctl(tree):
    """The settings of the kernel as the files give them: by name, a later file's over an earlier one's."""
    files = {}
    for folder in ("usr/lib/sysctl.d", "etc/sysctl.d"):
        found = tree.resolve(folder)
        if found and found.is_dir():
            files.update({each.name: tree.text(f"{folder}/{each.name}") for each in found.glob("*.conf")})
    values = {}
    for _, text in sorted(files.items()):
        for name, value in re.findall(r"^\s*-?([\w.*/-]+)\s*=\s*(\S+)", text, re.M):
            values[name] = value
    return values


def blocked_modules(tree):
    text = "".join(tree.text(f"etc/modprobe.d/{each.name}") for each in sorted((tree.root / "etc/modprobe.d").glob("*.conf"))) \
        if (tree.root / "etc/modprobe.d").is_dir() else ""
    return dict(re.findall(r"^install\s+(\S+)\s+(.+)$", text, re.M))


def firewall(tree):
    text = tree.text("etc/nftables.conf")
    if not re.search(r"hook input .*policy drop", text):
        yield "nftables.conf doesn't drop what it doesn't name"
    if "nftables.service" not in tree.wanted():
        yield "nftables.service doesn't start with the machine"
    if not re.search(r"^Requires=(.* )?nftables\.service", tree.unit("systemd-networkd.service") or "", re.M):
        yield "systemd-networkd.service doesn't require nftables.service: without a firewall the network comes up"
    ports = set(re.findall(r"\d+", " ".join(re.findall(r"elements = \{([^}]*)\}", text)))) | set(re.findall(r"(?:tcp|udp) dport (\d+)", text))
    for port in sorted(ports - {"7443", "5353", "68", "546"}, key=int):
        yield f"nftables.conf opens port {port}"


def read_numbers(path):
    """The numbers of users and groups that a file in the form of sysusers.d names."""
    numbers = {"user": {}, "group": {}}
    for line in pathlib.Path(path).read_text().splitlines():
        words = line.split()
        if not words or words[0] not in ("u", "g"):
            continue
        number, _, group = words[2].partition(":")
        if words[0] == "u":
            numbers["user"][words[1]] = number
        if not group:
            numbers["group"][words[1]] = number
    return numbers


def numbers_of(tree, numbers):
    """Files on the data partition belong to numbers, so a version must not give a number to somebody else."""
    for kind, path in (("user", "etc/passwd"), ("group", "etc/group")):
        found = {name: number for name, _, number, *_ in (line.split(":") for line in tree.text(path).splitlines() if line.count(":") > 2 or kind == "group")}
        for name, number in found.items():
            if name in numbers[kind] and number != numbers[kind][name]:
                yield f"the {kind} {name} has the number {number}, not {numbers[kind][name]}: its files on the data partition would be somebody else's"
            elif name not in numbers[kind] and 100 <= int(number) < 60000:
                yield f"the {kind} {name} has no number in users.conf: it may be another in the next version"
        yield from (f"users.conf has the {kind} {name}, whom the image doesn't have" for name in numbers[kind] if name not in found)


def audit(root, allowed, numbers=None):
    """Returns the faults, a sentence each. numbers: of read_numbers, if they are to be the same."""
    tree, faults = Tree(root), []
    used = {kind: set() for kind in KINDS}

    def take(kind, key, sentence):
        if key in allowed[kind]:
            used[kind].add(key)
        else:
            faults.append(f"{kind}: {sentence}")

    for key, sentence in listening(tree):
        take("listening", key, sentence)
    for key, sentence in services(tree):
        take("unit", key, sentence)
    for kind, key, sentence in rights(tree):
        take(kind, key, sentence)
    for key, sentence in shells(tree):
        take("shell", key, sentence)
    values = sysctl(tree)
    for line in allowed["setting"]:
        name, _, value = (part.strip() for part in line.partition("="))
        used["setting"].add(line)
        if values.get(name) != value:
            faults.append(f"setting: {name} is {values.get(name, 'not set')}, not {value}")
    modules = blocked_modules(tree)
    for line in allowed["module"]:
        used["module"].add(line)
        if "/bin/false" != modules.get(line) and not re.match(r"test -e /etc/prismesh/allow-\S+ && ", modules.get(line, "")):
            faults.append(f"module: {line} isn't blocked")
    for title, found in (("password", passwords), ("identity", identity), ("login", logins), ("firewall", firewall)):
        faults += [f"{title}: {sentence}" for sentence in found(tree)]
    if numbers:
        faults += [f"number: {sentence}" for sentence in numbers_of(tree, numbers)]
    for kind in KINDS:
        faults += [f"{kind}: the list allows '{key}', which the image doesn't have" for key in allowed[kind] if key not in used[kind]]
    return faults


def main():
    if len(sys.argv) != 3:
        print("usage: audit.py TREE LIST", file=sys.stderr)
        return 2
    faults = audit(sys.argv[1], read_list(sys.argv[2]), read_numbers(pathlib.Path(sys.argv[2]).with_name("users.conf")))
    for fault in faults:
        print(fault)
    print(f"{sys.argv[1]}: {len(faults)} faults" if faults else f"{sys.argv[1]}: the image has what the list allows, and nothing else")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
