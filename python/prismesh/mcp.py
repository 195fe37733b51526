"""A server of the Model Context Protocol over standard input and output: docs/mcp.md explains it.

    python3 -m prismesh.mcp [--root FOLDER] [--edits FOLDER] [--allow-overwrite]
"""
from __future__ import annotations

import argparse
import json
import os
import queue
import signal
import sys
import threading
import time
import traceback
from typing import Any

import prismesh
from prismesh._mcp_answers import fitted, problem_with, with_whole_numbers
from prismesh._mcp_tools import TOOLS, Refused, Tools

VERSIONS = ("2024-11-05", "2025-03-26", "2025-06-18")  # of the protocol, ascending
MAX_LINE = 4 << 20  # bytes
MAX_WAITING = 1000  # requests
MAX_BATCH = 100  # messages
MAX_ID = 1000  # characters
MAX_SENTENCE = 4000  # characters
BETWEEN_PROGRESS_S = 0.25
PARSE_ERROR, INVALID_REQUEST, UNKNOWN_METHOD, INVALID_PARAMS, INTERNAL_ERROR = -32700, -32600, -32601, -32602, -32603


class ProtocolError(Exception):
    def __init__(self, code: int, message: str):
        super().__init__(message)
        self.code = code


def lines_of(descriptor: int):
    """The lines of a descriptor, without line feeds; None for one that is too long, of which nothing is kept."""
    held, too_long = bytearray(), False
    while piece := os.read(descriptor, 1 << 16):
        *ends, rest = piece.split(b"\n")
        for end in ends:
            held += end
            yield None if too_long or len(held) > MAX_LINE else bytes(held)
            held.clear()
            too_long = False
        held += rest
        if len(held) > MAX_LINE:
            held.clear()
            too_long = True
    if held and not too_long:
        yield bytes(held)


def parsed(line: bytes) -> Any:
    """Raises ValueError for what isn't JSON."""
    def refuse(word: str) -> None:
        raise ValueError(word + " is no number of JSON")
    try:
        return json.loads(line.decode("utf-8"), parse_constant=refuse)
    except RecursionError:
        raise ValueError("nested too deeply") from None


def is_id(value: Any) -> bool:
    return (isinstance(value, int) and not isinstance(value, bool)) or (isinstance(value, str) and len(value) <= MAX_ID)


def is_ping(message: Any) -> bool:
    return (isinstance(message, dict) and message.get("jsonrpc") == "2.0" and message.get("method") == "ping" and is_id(message.get("id"))
            and isinstance(message.get("params", {}), dict))


class Server:
    def __init__(self, tools: Tools, out: int):
        self.tools = tools
        self.out = out
        self.version: str | None = None
        self.waiting: queue.Queue[Any] = queue.Queue(MAX_WAITING)
        self.ending = False
        self._idle = False
        self._cancelled: set[Any] = set()
        self._pending: set[Any] = set()
        self._lock = threading.Lock()
        self._sending = threading.Lock()
        self._by_name = {tool["name"]: tool for tool in TOOLS}

    # --- in and out ---

    def send(self, message: Any) -> None:
        line = json.dumps(message, allow_nan=False).encode("ascii") + b"\n"
        with self._sending:
            while line:
                line = line[os.write(self.out, line):]

    def read(self, descriptor: int) -> None:
        """Of a thread of its own, so that a request can be cancelled, and a ping answered, while another is worked."""
        signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))  # they are for the thread that works
        try:
            self._read(descriptor)
        except OSError:
            pass  # the client has gone
        self.waiting.put(None)

    def _read(self, descriptor: int) -> None:
        for line in lines_of(descriptor):
            if line is not None and not line.strip():
                continue
            try:
                if line is None:
                    raise ValueError(f"the line has more than {MAX_LINE} bytes")
                message = parsed(line)
            except (ValueError, MemoryError) as error:
                self.waiting.put(ProtocolError(PARSE_ERROR, f"not JSON: {str(error)[:200]}"))
                continue
            if is_ping(message):
                self.send({"jsonrpc": "2.0", "id": message["id"], "result": {}})
                continue
            if isinstance(message, list) and len(message) > MAX_BATCH:
                self.waiting.put(ProtocolError(INVALID_REQUEST, f"a batch has at most {MAX_BATCH} messages"))
                continue
            for each in message if isinstance(message, list) else [message]:
                self._look_for_cancel(each)
            self.waiting.put(message)

    def _look_for_cancel(self, message: Any) -> None:
        if not isinstance(message, dict):
            return
        with self._lock:
            if "method" in message and is_id(message.get("id")):
                self._pending.add(message["id"])
            params = message.get("params")
            if message.get("method") == "notifications/cancelled" and isinstance(params, dict) and is_id(params.get("requestId")):
                if params["requestId"] in self._pending:
                    self._cancelled.add(params["requestId"])

    def _is_cancelled(self, number: Any) -> bool:
        with self._lock:
            return number in self._cancelled

    def end(self, _signal: int, _frame: Any) -> None:
        """By a signal: at once when nothing is worked, or by a second one; else what is worked is stopped as by a cancel, so that its temporary files go."""
        if self._idle or self.ending:
            raise KeyboardInterrupt
        self.ending = True

    def _next(self) -> Any:
        try:
            self._idle = True
            return None if self.ending else self.waiting.get()
        finally:
            self._idle = False

    def serve(self) -> None:
        while (message := self._next()) is not None:
            if isinstance(message, ProtocolError):
                self.send(self._error(None, message))
            elif isinstance(message, list) and message and self.version == "2025-03-26":  # the only version with batches
                answers = [answer for each in message if (answer := self.answer(each)) is not None]
                if answers:
                    self.send(answers)
            elif (answer := self.answer(message)) is not None:
                self.send(answer)

    @staticmethod
    def _error(number: Any, error: ProtocolError) -> dict[str, Any]:
        return {"jsonrpc": "2.0", "id": number, "error": {"code": error.code, "message": str(error)[:MAX_SENTENCE]}}

    # --- requests ---

    def answer(self, message: Any) -> dict[str, Any] | None:
        """The response to a message; None: there is none to be sent."""
        if isinstance(message, list):  # one that isn't a batch
            for each in message:
                self._forget(each.get("id") if isinstance(each, dict) else None)
        if not isinstance(message, dict) or message.get("jsonrpc") != "2.0":
            self._forget(message.get("id") if isinstance(message, dict) else None)
            return self._error(None, ProtocolError(INVALID_REQUEST, "a message is an object with \"jsonrpc\": \"2.0\""))
        if "method" not in message and ("result" in message or "error" in message):
            return None  # a response, though this server asks nothing
        number = message.get("id")
        if "id" in message and not is_id(number):  # nothing of it is sent back
            return self._error(None, ProtocolError(INVALID_REQUEST, f"the id of a request is a text of at most {MAX_ID} characters or a whole number"))
        try:
            if not isinstance(message.get("method"), str):
                raise ProtocolError(INVALID_REQUEST, "a request names its method")
            if "id" not in message:
                return None  # a notification
            if self._is_cancelled(number):
                return None
            params = message.get("params", {})
            if not isinstance(params, dict):
                raise ProtocolError(INVALID_PARAMS, "params must be an object")
            result = self._result(message["method"], params, number)
            return None if result is None else {"jsonrpc": "2.0", "id": number, "result": result}
        except ProtocolError as error:
            return self._error(number, error)
        except (BrokenPipeError, KeyboardInterrupt):
            raise
        except Exception:  # a fault of the server's own: the next request is served
            traceback.print_exc(file=sys.stderr)
            return self._error(number, ProtocolError(INTERNAL_ERROR, "a fault of the server; its standard error has more"))
        finally:
            self._forget(number)

    def _forget(self, number: Any) -> None:
        if is_id(number):
            with self._lock:
                self._pending.discard(number)
                self._cancelled.discard(number)

    def _result(self, method: str, params: dict[str, Any], number: Any) -> dict[str, Any] | None:
        if method == "initialize":
            return self._initialize(params)
        if method == "ping":
            return {}
        if method not in ("tools/list", "tools/call"):
            raise ProtocolError(UNKNOWN_METHOD, f"there is no method \"{method[:80]}\"")
        if self.version is None:
            raise ProtocolError(INVALID_REQUEST, "the first request must be initialize")
        return {"tools": [self._shown(tool) for tool in TOOLS]} if method == "tools/list" else self._call(params, number)

    def _initialize(self, params: dict[str, Any]) -> dict[str, Any]:
        if not isinstance(params.get("protocolVersion"), str):
            raise ProtocolError(INVALID_PARAMS, "initialize names its protocolVersion")
        self.version = params["protocolVersion"] if params["protocolVersion"] in VERSIONS else VERSIONS[-1]
        return {
            "protocolVersion": self.version,
            "capabilities": {"tools": {"listChanged": False}},
            "serverInfo": {"name": "prismesh", "version": prismesh.__version__},
            "instructions": "Edits finite-element shell decks of crash simulation. Open a deck, describe it, select, edit, check the quality, save to a new file. Everything can be undone; "
                            f"the source is left as it is. Files must lie below {self.tools.root}.",
        }

    def _shown(self, tool: dict[str, Any]) -> dict[str, Any]:
        """Without what the protocol's version doesn't know."""
        since = {"annotations": VERSIONS[1], "title": VERSIONS[2]}
        return {key: value for key, value in tool.items() if (self.version or "") >= since.get(key, "")}

    def _call(self, params: dict[str, Any], number: Any) -> dict[str, Any] | None:
        name, arguments = params.get("name"), params.get("arguments", {})
        tool = self._by_name.get(name) if isinstance(name, str) else None
        if tool is None:
            named = json.dumps(name)[:80] if isinstance(name, str) else "without a name"
            raise ProtocolError(INVALID_PARAMS, f"there is no tool {named}; the tools are {', '.join(self._by_name)}")
        if problem := problem_with(arguments, tool["inputSchema"]):
            raise ProtocolError(INVALID_PARAMS, f"{name}: {problem}")
        meta = params.get("_meta")
        token = meta.get("progressToken") if isinstance(meta, dict) else None
        try:
            answer = getattr(self.tools, name)(with_whole_numbers(arguments, tool["inputSchema"]), self._progress(number, token))
        except prismesh.Cancelled:
            return None  # a request that was cancelled gets no response
        except prismesh.Error as error:
            return self._failure(str(error), {"file": error.file, "line": error.line, "message": error.message})
        except Refused as error:
            return self._failure(str(error), {"file": None, "line": None, "message": str(error)})
        except BrokenPipeError:
            raise
        except OSError as error:
            sentence = f"{error.filename or 'a file'}: {error.strerror}"
            return self._failure(sentence, {"file": error.filename, "line": None, "message": str(error.strerror)})
        except TypeError as error:
            return self._failure(str(error), {"file": None, "line": None, "message": str(error)})
        except RecursionError:
            raise ProtocolError(INVALID_PARAMS, f"{name}: nested too deeply") from None
        except MemoryError:
            return self._failure("there isn't enough memory", {"file": None, "line": None, "message": "there isn't enough memory"})
        text, shown = fitted(answer)
        return self._content(text, shown, False)

    def _failure(self, sentence: str, about: dict[str, Any]) -> dict[str, Any]:
        about = {key: value[:MAX_SENTENCE] if isinstance(value, str) else value for key, value in about.items()}
        return self._content(sentence[:MAX_SENTENCE], about, True)

    def _content(self, text: str, shown: dict[str, Any], is_error: bool) -> dict[str, Any]:
        result: dict[str, Any] = {"content": [{"type": "text", "text": text}], "isError": is_error}
        if self.version == VERSIONS[2]:
            result["structuredContent"] = shown
        return result

    def _progress(self, number: Any, token: Any):
        last, highest = 0.0, 0.0

        def tell(fraction: float, words: str) -> bool:
            nonlocal last, highest
            now = time.monotonic()
            if is_id(token) and now - last >= BETWEEN_PROGRESS_S and fraction > highest:  # the protocol wants it to rise
                last, highest = now, fraction
                told = {"progressToken": token, "progress": fraction, "total": 1}
                self.send({"jsonrpc": "2.0", "method": "notifications/progress", "params": told if self.version == VERSIONS[0] else {**told, "message": words[:200]}})
            return not self.ending and not self._is_cancelled(number)
        return tell


def state_folder() -> str:
    state = os.environ.get("XDG_STATE_HOME") or os.path.join(os.path.expanduser("~"), ".local", "state")
    return os.path.join(state, "prismesh", "mcp")


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m prismesh.mcp", description="Serves the Model Context Protocol over standard input and output.")
    parser.add_argument("--root", default=".", metavar="FOLDER", help="only files below it are read and written; default: the working folder")
    parser.add_argument("--edits", default=state_folder(), metavar="FOLDER", help="where edits are kept until a document is closed; default: %(default)s")
    parser.add_argument("--allow-overwrite", action="store_true", help="lets \"overwrite\" of the tool save replace files, the source among them")
    parser.add_argument("--version", action="version", version="prismesh " + prismesh.__version__)
    options = parser.parse_args()
    if not os.path.isdir(options.root):
        parser.error(f"{options.root}: there is no such folder")
    # What something else prints must not get between the messages.
    out = os.dup(1)
    os.dup2(2, 1)
    server = Server(Tools(options.root, os.path.realpath(options.edits), options.allow_overwrite), out)
    os.chdir(server.tools.root)  # what is relative is below it
    for each in (signal.SIGINT, signal.SIGTERM):
        signal.signal(each, server.end)
    threading.Thread(target=server.read, args=(0,), daemon=True).start()
    try:
        server.serve()
    except (BrokenPipeError, KeyboardInterrupt):
        pass  # the client has gone
    finally:
        for each in (signal.SIGINT, signal.SIGTERM):
            signal.signal(each, signal.SIG_IGN)
        server.tools.shut_down()
    return 0


if __name__ == "__main__":
    sys.exit(main())
