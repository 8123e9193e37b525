"""Headless Chromium by its own protocol, over two pipes: a page, what it says, pictures of it, and a hand for it."""
import base64
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import threading
import time


class Chromium:
    """A browser with one page. complaints: errors and warnings of its console, exceptions, and requests that failed, in order."""

    def __init__(self, width=1280, height=720, scale=1, touch=False):
        program = shutil.which("chromium")
        if program is None:
            raise FileNotFoundError("there is no chromium; Debian's package is called so")
        self.complaints, self.console = [], []
        self.answers, self.number, self.session = {}, 0, None
        self.arrived = threading.Condition()
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_read, self.to = os.pipe()
        self.come, come_write = os.pipe()
        # No sandbox: it asks for rights that a container lacks, and what runs is ours. SwiftShader draws where there is no GPU.
        words = [program, "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run", "--remote-debugging-pipe", "--use-gl=angle",
                 "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--disable-background-timer-throttling",
                 "--disable-renderer-backgrounding", "--enable-precise-memory-info", "--js-flags=--expose-gc",
                 f"--user-data-dir={self.profile.name}", "about:blank"]

        def pipes():  # 3: commands, 4: answers
            os.dup2(to_read, 103)
            os.dup2(come_write, 104)
            os.dup2(103, 3)
            os.dup2(104, 4)

        self.log = tempfile.TemporaryFile("w+", errors="replace")
        self.process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self.log, preexec_fn=pipes,
                                        pass_fds=(3, 4), start_new_session=True)
        os.close(to_read)
        os.close(come_write)
        threading.Thread(target=self._listen, daemon=True).start()
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.ask(domain + ".enable")
        self.ask("Target.setAutoAttach", autoAttach=True, waitForDebuggerOnStart=False, flatten=True)
        self.resize(width, height, scale, touch)

    def resize(self, width, height, scale=1, touch=False):
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=touch)
        self.ask("Emulation.setTouchEmulationEnabled", enabled=touch, maxTouchPoints=5 if touch else 1)

    def _listen(self):
        rest = b""
        while True:
            try:
                piece = os.read(self.come, 1 << 20)
            except OSError:
                piece = b""
            if not piece:
                with self.arrived:
                    self.answers[None] = True
                    self.arrived.notify_all()
                return
            *messages, rest = (rest + piece).split(b"\0")
            for message in messages:
                self._take(json.loads(message))

    def _take(self, message):
        if "id" in message:
            with self.arrived:
                self.answers[message["id"]] = message
                self.arrived.notify_all()
            return
        method, what = message.get("method"), message.get("params", {})
        if method == "Runtime.consoleAPICalled":
            text = " ".join(str(word.get("value", word.get("description", ""))) for word in what["args"])
            self.console.append(text)
            if what["type"] in ("error", "warning", "assert"):
                self.complaints.append(f"{what['type']}: {text}")
        elif method == "Runtime.exceptionThrown":
            details = what["exceptionDetails"]
            self.complaints.append("exception: " + details.get("exception", {}).get("description", details["text"]))
        elif method == "Log.entryAdded" and what["entry"]["level"] in ("error", "warning"):
            self.complaints.append(f"{what['entry']['level']}: {what['entry']['text']} {what['entry'].get('url', '')}")
        elif method == "Target.attachedToTarget":  # a worker
            self.tell("Runtime.enable", session=what["sessionId"])

    def tell(self, method, session=None, **words):
        self.number += 1
        message = {"id": self.number, "method": method, "params": words}
        if session or self.session:
            message["sessionId"] = session or self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        return self.number

    def ask(self, method, limit=120, **words):
        number = self.tell(method, **words)
        until = time.monotonic() + limit
        with self.arrived:
            while number not in self.answers:
                if None in self.answers:
                    raise RuntimeError("Chromium has ended")
                if not self.arrived.wait(max(until - time.monotonic(), 0)) and time.monotonic() >= until:
                    raise TimeoutError(f"{method}: no answer within {limit} s")
            answer = self.answers.pop(number)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error'].get('message')}")
        return answer["result"]

    def open(self, address):
        self.ask("Page.navigate", url=address)

    def run(self, expression, limit=120):
        """The value of a JavaScript expression in the page, awaited."""
        answer = self.ask("Runtime.evaluate", limit=limit, expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise RuntimeError(f"{expression[:80]}: " + details.get("exception", {}).get("description", details["text"]))
        return answer["result"].get("value")

    def wait(self, condition, limit=60):
        """Until a JavaScript condition holds. Returns the seconds that took."""
        begun = time.monotonic()
        while not self.run(condition):
            if time.monotonic() - begun > limit:
                raise TimeoutError(f"not within {limit} s: {condition}\n" + "\n".join(self.complaints))
            time.sleep(0.05)
        return time.monotonic() - begun

    def picture(self, path):
        data = base64.b64decode(self.ask("Page.captureScreenshot", format="png")["data"])
        pathlib.Path(path).parent.mkdir(parents=True, exist_ok=True)
        pathlib.Path(path).write_bytes(data)

    def mouse(self, kind, x, y, button="left", buttons=None, **more):
        """kind: mousePressed, mouseMoved, mouseReleased, mouseWheel."""
        if buttons is None:
            buttons = 0 if kind == "mouseReleased" else {"none": 0, "left": 1, "right": 2, "middle": 4}[button]
        self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, buttons=buttons, clickCount=1 if kind != "mouseMoved" else 0, **more)

    def drag(self, places, seconds=1.0, button="left"):
        """Presses at the first place, goes through the others, and lets go."""
        self.mouse("mousePressed", *places[0], button=button)
        for place in places[1:]:
            time.sleep(seconds / max(len(places) - 1, 1))
            self.mouse("mouseMoved", *place, button=button)
        self.mouse("mouseReleased", *places[-1], button=button)

    def touch(self, kind, places):
        """kind: touchStart, touchMove, touchEnd."""
        self.ask("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y, "id": n} for n, (x, y) in enumerate(places)])

    def key(self, key, code=None, modifiers=0):
        for kind in ("keyDown", "keyUp"):
            self.ask("Input.dispatchKeyEvent", type=kind, key=key, code=code or key, modifiers=modifiers)

    def close(self):
        for number in (signal.SIGTERM, signal.SIGKILL):
            try:
                os.killpg(self.process.pid, number)
                self.process.wait(5)
            except (ProcessLookupError, subprocess.TimeoutExpired):
                pass
        self.profile.cleanup()
        self.log.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
