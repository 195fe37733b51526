#!/usr/bin/env python3
"""The audit of an image's root finds each kind of fault: plants one at a time in a small tree that is as it should be."""
import os
import pathlib
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import audit  # noqa: E402

LIST = """[listening]
[setuid]
[writable]
/tmp  # sticky
[shell]
root  # for a placed key
[setting]
kernel.sysrq = 0  # no key reaches the kernel
[module]
usb_storage  # sticks
floppy  # none
[unit]
nftables.service  # the firewall
modeld.service  # the document
"""
SYSTEM = "usr/lib/systemd/system"
FIREWALL = """table inet station {
  set ports {
    elements = { 7443 }
  }
  chain input {
    type filter hook input priority filter; policy drop;
    udp dport 5353 accept
    tcp dport @ports accept
  }
}
"""


class Audit(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name) / "root"
        self.write("etc/passwd", "root:x:0:0::/root:/bin/bash\nkiosk:x:990:990::/:/usr/sbin/nologin\n")
        self.write("etc/shadow", "root:*:19675::::::\nkiosk:!*:19675::::::\n", 0o640)
        self.write("etc/shells", "# shells\n/bin/sh\n/bin/bash\n")
        self.write("etc/machine-id", "")
        self.write("etc/nftables.conf", FIREWALL)
        self.write("etc/sysctl.d/60-station.conf", "kernel.sysrq = 0\n")
        self.write("usr/lib/sysctl.d/50-default.conf", "kernel.sysrq = 0x01b6\n")
        self.write("etc/modprobe.d/station.conf", "install floppy /bin/false\ninstall usb_storage test -e /etc/prismesh/allow-usb-storage && /sbin/modprobe --ignore-install usb_storage\n")
        self.write(f"{SYSTEM}/modeld.service", "[Service]\nExecStart=/usr/bin/modeld\n")
        self.write(f"{SYSTEM}/nftables.service", "[Service]\nExecStart=/usr/sbin/nft\n")
        self.write(f"{SYSTEM}/systemd-networkd.service", "[Service]\nExecStart=/usr/lib/networkd\n")
        self.write(f"{SYSTEM}/systemd-networkd.service.d/station.conf", "[Unit]\nRequires=nftables.service\n")
        self.write(f"{SYSTEM}/getty@.service", "[Service]\nExecStart=-/sbin/agetty\n")
        self.write(f"{SYSTEM}/serial-getty@.service", "[Service]\nExecStart=-/sbin/agetty\n")
        self.write(f"{SYSTEM}/debug-shell.service", "[Service]\nExecStart=/bin/sh\n")
        self.write(f"{SYSTEM}/ssh.service", "[Service]\nExecStart=/usr/sbin/sshd\n")
        self.write(f"{SYSTEM}/model.socket", "[Socket]\nListenStream=/run/prismesh/model.sock\n")
        self.write("usr/lib/systemd/system-generators/systemd-getty-generator", "", 0o755)
        for name in ("getty@.service", "serial-getty@.service", "autovt@.service", "debug-shell.service"):
            self.link(f"etc/systemd/system/{name}", "/dev/null")
        self.link("etc/systemd/system-generators/systemd-getty-generator", "/dev/null")
        for name in ("modeld.service", "nftables.service"):
            self.want(name)
        self.want("model.socket", "sockets.target")
        (self.root / "tmp").mkdir()
        (self.root / "tmp").chmod(0o1777)
        self.list = pathlib.Path(self.folder.name) / "allowed.txt"
        self.list.write_text(LIST)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, path, text, mode=0o644):
        at = self.root / path
        at.parent.mkdir(parents=True, exist_ok=True)
        at.write_text(text)
        at.chmod(mode)

    def link(self, path, target):
        at = self.root / path
        at.parent.mkdir(parents=True, exist_ok=True)
        at.symlink_to(target)

    def want(self, name, by="multi-user.target"):
        self.link(f"etc/systemd/system/{by}.wants/{name}", f"/{SYSTEM}/{name}")

    def faults(self):
        return audit.audit(self.root, audit.read_list(self.list))

    def finds(self, *words):
        faults = self.faults()
        self.assertEqual(len(faults), 1, faults)
        for word in words:
            self.assertIn(word, faults[0])

    def test_a_good_tree_has_no_fault(self):
        self.assertEqual(self.faults(), [])

    def test_a_port(self):
        self.write(f"{SYSTEM}/echo.socket", "[Socket]\nListenStream=7\n")
        self.want("echo.socket", "sockets.target")
        self.finds("listening", "echo.socket", "7")

    def test_a_port_that_a_drop_in_adds(self):
        self.write("etc/systemd/system/model.socket.d/more.conf", "[Socket]\nListenStream=0.0.0.0:9000\n")
        self.finds("listening", "model.socket", "9000")

    def test_a_file_with_rights_of_its_owner(self):
        self.write("usr/bin/su", "", 0o755)
        (self.root / "usr/bin/su").chmod(0o4755)
        self.finds("setuid", "/usr/bin/su")

    def test_a_file_with_rights_of_its_group(self):
        self.write("usr/bin/wall", "", 0o755)
        (self.root / "usr/bin/wall").chmod(0o2755)
        self.finds("setuid", "/usr/bin/wall")

    def test_a_file_that_everybody_writes(self):
        self.write("usr/bin/tool", "", 0o755)
        (self.root / "usr/bin/tool").chmod(0o777)
        self.finds("writable", "/usr/bin/tool")

    def test_a_folder_that_everybody_writes(self):
        (self.root / "opt").mkdir()
        (self.root / "opt").chmod(0o777)
        self.finds("writable", "/opt")

    def test_a_user_with_a_shell(self):
        self.write("etc/passwd", "root:x:0:0::/root:/bin/bash\nkiosk:x:990:990::/:/bin/sh\n")
        self.finds("shell", "kiosk")

    def test_a_user_whose_shell_is_left_out(self):
        self.write("etc/passwd", "root:x:0:0::/root:/bin/bash\nkiosk:x:990:990::/:\n")
        self.finds("shell", "kiosk")

    def test_a_password(self):
        self.write("etc/shadow", "root:$6$salt$hash:19675::::::\n", 0o640)
        self.finds("password", "root")

    def test_an_empty_password(self):
        self.write("etc/shadow", "root::19675::::::\n", 0o640)
        self.finds("password", "root", "empty")

    def test_a_private_key_that_everybody_reads(self):
        self.write("etc/prismesh/tls.key", "-----BEGIN PRIVATE KEY-----\n")
        self.finds("identity", "tls.key", "everybody")

    def test_a_private_key_of_the_owner(self):
        self.write("etc/prismesh/tls.pem", "-----BEGIN RSA PRIVATE KEY-----\n", 0o600)
        self.finds("identity", "tls.pem")

    def test_a_certificate_is_no_fault(self):
        self.write("etc/rauc/keyring.pem", "-----BEGIN CERTIFICATE-----\n")
        self.assertEqual(self.faults(), [])

    def test_a_key_of_the_remote_shell(self):
        self.write("etc/ssh/ssh_host_ed25519_key", "", 0o600)
        self.finds("identity", "ssh_host_ed25519_key")

    def test_a_placed_key(self):
        self.write("etc/prismesh/ssh/authorized_keys", "ssh-ed25519 AAAA somebody\n")
        self.finds("identity", "authorized_keys")

    def test_the_number_of_a_machine(self):
        self.write("etc/machine-id", "0123456789abcdef0123456789abcdef\n")
        self.finds("identity", "machine-id")

    def test_a_host_name(self):
        self.write("etc/hostname", "station\n")
        self.finds("identity", "hostname")

    def test_a_login_that_starts(self):
        (self.root / "etc/systemd/system/getty@.service").unlink()
        self.link("etc/systemd/system/getty.target.wants/getty@tty1.service", f"/{SYSTEM}/getty@.service")
        self.link("etc/systemd/system/multi-user.target.wants/getty.target", f"/{SYSTEM}/getty.target")
        self.write(f"{SYSTEM}/getty.target", "[Unit]\n")
        self.assertTrue(any("getty@tty1.service" in fault and fault.startswith("login") for fault in self.faults()))

    def test_a_login_that_isn_t_masked(self):
        (self.root / "etc/systemd/system/serial-getty@.service").unlink()
        self.finds("login", "serial-getty@.service")

    def test_a_generator_of_logins(self):
        (self.root / "etc/systemd/system-generators/systemd-getty-generator").unlink()
        self.finds("login", "systemd-getty-generator")

    def test_the_remote_shell_that_starts(self):
        self.want("ssh.service")
        faults = self.faults()
        self.assertTrue(any(fault.startswith("login") and "ssh.service" in fault for fault in faults), faults)

    def test_a_service_that_the_list_doesn_t_name(self):
        self.write(f"{SYSTEM}/cups.service", "[Service]\nExecStart=/usr/sbin/cupsd\n")
        self.want("cups.service")
        self.finds("unit", "cups.service")

    def test_a_setting_of_the_kernel(self):
        self.write("etc/sysctl.d/70-later.conf", "kernel.sysrq = 1\n")
        self.finds("setting", "kernel.sysrq is 1")

    def test_a_setting_that_is_missing(self):
        (self.root / "etc/sysctl.d/60-station.conf").unlink()
        self.finds("setting", "kernel.sysrq")

    def test_a_driver_that_isn_t_blocked(self):
        self.write("etc/modprobe.d/station.conf", "install floppy /bin/false\n")
        self.finds("module", "usb_storage")

    def test_an_open_firewall(self):
        self.write("etc/nftables.conf", FIREWALL.replace("policy drop", "policy accept"))
        self.finds("firewall", "drop")

    def test_a_port_in_the_firewall(self):
        self.write("etc/nftables.conf", FIREWALL.replace("{ 7443 }", "{ 7443, 22 }"))
        self.finds("firewall", "port 22")

    def test_a_firewall_that_doesn_t_start(self):
        (self.root / "etc/systemd/system/multi-user.target.wants/nftables.service").unlink()
        self.assertTrue(any(fault.startswith("firewall") for fault in self.faults()))

    def test_a_network_without_the_firewall(self):
        self.write(f"{SYSTEM}/systemd-networkd.service.d/station.conf", "[Unit]\nAfter=nftables.service\n")
        self.finds("firewall", "systemd-networkd.service doesn't require nftables.service")

    def numbers(self, text):
        path = pathlib.Path(self.folder.name) / "users.conf"
        path.write_text(text)
        self.write("etc/group", "root:x:0:\nnogroup:x:65534:\nkiosk:x:990:\n")
        return audit.audit(self.root, audit.read_list(self.list), audit.read_numbers(path))

    def test_numbers_that_are_the_same(self):
        self.assertEqual(self.numbers("# why\nu kiosk 990 \"Kiosk\" /\n"), [])
        self.assertEqual(self.numbers("g kiosk 990\nu kiosk 990:990 - /\n"), [])

    def test_a_user_and_a_group_with_another_number(self):
        faults = self.numbers("u kiosk 991\n")
        self.assertEqual([fault.split(":")[1][:45] for fault in faults], [" the user kiosk has the number 990, not 991", " the group kiosk has the number 990, not 991"])

    def test_a_user_without_a_number_and_a_number_without_a_user(self):
        faults = self.numbers("g kiosk 990\nu modeld 992:990\n")
        self.assertEqual(len(faults), 2, faults)
        self.assertIn("the user kiosk has no number", faults[0])
        self.assertIn("the user modeld, whom the image doesn't have", faults[1])

    def test_a_line_of_the_list_for_nothing(self):
        self.list.write_text(LIST + "cups.service  # prints\n")
        self.finds("unit", "cups.service", "doesn't have")

    def test_a_line_without_reason_is_refused(self):
        self.list.write_text(LIST + "cups.service\n")
        with self.assertRaisesRegex(SystemExit, "no reason"):
            self.faults()

    def test_links_lead_inside_the_tree(self):
        self.link("etc/outside", "/etc/shadow")
        self.assertEqual(audit.Tree(self.root).resolve("etc/outside"), self.root / "etc/shadow")

    def test_the_kept_numbers_are_those_of_all_our_users(self):
        project = HERE.parents[1]
        kept = audit.read_numbers(project / "scripts/image/users.conf")
        ours = audit.read_numbers(project / "systemd/sysusers.d/prismesh.conf")
        self.assertEqual([name for kind in ours for name in ours[kind] if name not in kept[kind]], [])
        for kind in kept:
            self.assertEqual(len(set(kept[kind].values())), len(kept[kind]), "two have one number")

    def test_the_kept_list_can_be_read(self):
        allowed = audit.read_list(HERE.parents[1] / "scripts/image/allowed.txt")
        self.assertIn("kernel.sysrq = 0", allowed["setting"])


if __name__ == "__main__":
    unittest.main()
