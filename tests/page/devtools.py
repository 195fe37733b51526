"""Chromium without a window, led by its DevTools protocol over a pipe (--remote-debugging-pipe: messages of JSON, each ended by a zero byte).

https://chromedevtools.github.io/devtools-protocol/
"""
import base64
import contextlib
import fcntl
import hashlib
import json
import os
import pathlib
import queue
import shutil
import ssl
import subprocess
import threading
import time

PATIENCE_S = 30


def chromium():
    """The program, or None."""
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


def key_hash(address):
    """SHA-256 of the public key of a server's certificate in base64, as --ignore-certificate-errors-spki-list takes it."""
    certificate = ssl.PEM_cert_to_DER_cert(ssl.get_server_certificate(address))

    def element(at):
        """Where the content of the DER element at `at` begins, and where it ends."""
        size, begin = certificate[at + 1], at + 2
        if size >= 0x80:
            count = size & 0x7F
            size, begin = int.from_bytes(certificate[begin : begin + count], "big"), begin + count
        return begin, begin + size

    at, _ = element(element(0)[0])  # TBSCertificate
    # version, serialNumber, signature, issuer, validity, subject, and then subjectPublicKeyInfo
    for _ in range(6):
        at = element(at)[1]
    return base64.b64encode(hashlib.sha256(certificate[at : element(at)[1]]).digest()).decode()


class Failed(Exception):
    pass


class Browser:
    def __init__(self, folder, trusted_keys):
        to_browser, from_browser = os.pipe(), os.pipe()
        # High numbers, so that none of them is 3 or 4.
        read, write = (fcntl.fcntl(each, fcntl.F_DUPFD_CLOEXEC, 20) for each in (to_browser[0], from_browser[1]))
        for each in (to_browser[0], from_browser[1]):
            os.close(each)

        def put_pipes():
            os.dup2(read, 3)
            os.dup2(write, 4)

        command = [
            chromium(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run", "--disable-background-networking",
            "--disable-component-update", "--disable-sync", "--disable-extensions", "--remote-debugging-pipe", f"--user-data-dir={folder}",
            "--ignore-certificate-errors-spki-list=" + ",".join(trusted_keys), "about:blank",
        ]  # fmt: skip
        self.log = open(pathlib.Path(folder).parent / "chromium.log", "wb")
        environment = {**os.environ, "HOME": str(folder)}
        self.process = subprocess.Popen(command, pass_fds=(3, 4), preexec_fn=put_pipes, stdin=subprocess.DEVNULL, stdout=self.log, stderr=self.log, env=environment)
        os.close(read)
        os.close(write)
        self.writing = os.fdopen(to_browser[1], "wb", buffering=0)
        self.reading = os.fdopen(from_browser[0], "rb", buffering=0)
        self.last = 0
        self.answers = {}
        self.arrived = threading.Condition()
        self.listeners = []
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        rest = b""
        while piece := self.reading.read(1 << 20):
            *messages, rest = (rest + piece).split(b"\0")
            for message in map(json.loads, messages):
                with self.arrived:
                    if "id" in message:
                        self.answers[message["id"]] = message
                        self.arrived.notify_all()
                for listener in list(self.listeners) if "method" in message else []:
                    listener(message)

    def call(self, method, session=None, **parameters):
        with self.arrived:
            self.last += 1
            number = self.last
        message = {"id": number, "method": method, "params": parameters, **({"sessionId": session} if session else {})}
        self.writing.write(json.dumps(message).encode() + b"\0")
        with self.arrived:
            if not self.arrived.wait_for(lambda: number in self.answers, PATIENCE_S):
                raise Failed(f"no answer to {method}")
            answer = self.answers.pop(number)
        if "error" in answer:
            raise Failed(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def close(self):
        with contextlib.suppress(Failed, OSError):
            self.call("Browser.close")
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        for file in (self.log, self.writing, self.reading):
            file.close()


class Tab:
    """A tab with cookies and storage of its own."""

    def __init__(self, browser, downloads):
        self.browser = browser
        self.context = browser.call("Target.createBrowserContext")["browserContextId"]
        target = browser.call("Target.createTarget", url="about:blank", browserContextId=self.context)["targetId"]
        self.session = browser.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.complaints = []  # of the console, the policy, the network
        self.downloaded = queue.Queue()
        browser.listeners.append(self._hear)
        for domain in ("Page", "Runtime", "Log", "DOM", "Accessibility", "Network", "Audits"):
            self.call(f"{domain}.enable")
        self.call("Emulation.setFocusEmulationEnabled", enabled=True)
        browser.call("Browser.setDownloadBehavior", behavior="allow", browserContextId=self.context, downloadPath=str(downloads), eventsEnabled=True)

    def _hear(self, message):
        method, parameters = message["method"], message["params"]
        if method == "Browser.downloadProgress" and parameters["state"] != "inProgress":
            self.downloaded.put((parameters["state"], parameters.get("filePath", "")))
        if message.get("sessionId") != self.session:
            return
        if method == "Runtime.exceptionThrown":
            detail = parameters["exceptionDetails"]
            self.complaints.append(("script", detail["text"] + " " + detail.get("exception", {}).get("description", "")))
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
            self.complaints.append(("script", json.dumps(parameters["args"])))
        elif method == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
            entry = parameters["entry"]
            self.complaints.append((entry["source"], f"{entry['text']} {entry.get('url', '')}"))
        elif method == "Audits.issueAdded" and parameters["issue"]["code"] == "ContentSecurityPolicyIssue":
            self.complaints.append(("security", json.dumps(parameters["issue"]["details"])))

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def open(self, url):
        self.call("Page.navigate", url=url)
        self.wait("document.readyState === 'complete'")

    def reload(self):
        self.run("window.before = true")
        self.call("Page.reload")
        self.wait("!window.before && document.readyState === 'complete'")

    def run(self, expression):
        """The value of an expression, once it is there."""
        done = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in done:
            raise Failed(f"{expression}: {done['exceptionDetails'].get('exception', {}).get('description')}")
        return done["result"].get("value")

    def wait(self, expression, patience_s=PATIENCE_S):
        """Waits until the expression is true, and returns its value."""
        until = time.monotonic() + patience_s
        value = None
        while time.monotonic() < until:
            # While a page is being loaded there is nobody to ask.
            with contextlib.suppress(Failed):
                value = self.run(expression)
                if value:
                    return value
            time.sleep(0.05)
        raise Failed(f"never true: {expression}; the page says:\n{self.run('document.body.innerText')}\n{self.complaints}")

    def text(self):
        return self.run("document.body.innerText")

    def wait_for_text(self, text, patience_s=PATIENCE_S):
        self.wait(f"document.body.innerText.includes({json.dumps(text)})", patience_s)

    # --- hands ---

    KEYS = {"Tab": (9, ""), "Enter": (13, "\r"), " ": (32, " "), "Escape": (27, "")}

    def key(self, key):
        code, text = self.KEYS[key]
        common = {"key": key, "code": "Space" if key == " " else key, "windowsVirtualKeyCode": code}
        self.call("Input.dispatchKeyEvent", type="keyDown", **common, **({"text": text} if text else {}))
        self.call("Input.dispatchKeyEvent", type="keyUp", **common)

    def type(self, text):
        self.call("Input.insertText", text=text)

    def tab_to(self, selector):
        """Goes to a control by the keyboard alone."""
        for _ in range(60):
            if self.run(f"document.activeElement?.matches({json.dumps(selector)}) ?? false"):
                return
            self.key("Tab")
        raise Failed(f"the keyboard doesn't reach {selector}; it is at {self.run('document.activeElement.outerHTML.slice(0, 300)')}")

    def click(self, selector):
        """Presses it where it lies. What comes from the station can move it before the button is up: then again, as a user would."""
        for _ in range(5):
            x, y = self.run(
                f"(() => {{ const it = document.querySelector({json.dumps(selector)}); it.scrollIntoView({{block: 'center'}});"
                " window.pressed = false; it.addEventListener('click', () => { window.pressed = true; }, {once: true});"
                " const box = it.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()"
            )
            for kind in ("mousePressed", "mouseReleased"):
                self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
            if self.run("window.pressed !== false"):
                return
        raise Failed(f"five presses at {selector} reached something else")

    def choose_files(self, selector, paths):
        node = self.call("Runtime.evaluate", expression=f"document.querySelector({json.dumps(selector)})")["result"]["objectId"]
        self.call("DOM.setFileInputFiles", objectId=node, files=[str(path) for path in paths])

    def drop_files(self, selector, paths):
        x, y = self.run(f"(() => {{ const box = document.querySelector({json.dumps(selector)}).getBoundingClientRect(); return [box.x + 20, box.y + 20]; }})()")
        data = {"items": [], "files": [str(path) for path in paths], "dragOperationsMask": 1}
        for kind in ("dragEnter", "dragOver", "drop"):
            self.call("Input.dispatchDragEvent", type=kind, x=x, y=y, data=data)

    def size(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def scheme(self, name):
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": name}, {"name": "prefers-reduced-motion", "value": "reduce"}])

    def picture(self, path):
        """Of the whole page."""
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=True)["data"]
        pathlib.Path(path).write_bytes(base64.b64decode(data))

    def named_nodes(self):
        """[(role, name)] of what assistive programs are told of."""
        nodes = self.call("Accessibility.getFullAXTree")["nodes"]
        return [(node["role"]["value"], node.get("name", {}).get("value", "")) for node in nodes if not node["ignored"]]
