"""What the server of prismesh.mcp takes and gives: arguments against their schema, and answers of a limited size."""
from __future__ import annotations

import json
from typing import Any

MAX_ANSWER = 60_000  # characters of a tool's JSON
MAX_TEXT = 2_000  # of a text in it
TYPES = {"string": str, "boolean": bool, "object": dict, "array": list, "integer": int, "number": (int, float)}


def _is_a(value: Any, kind: str) -> bool:
    if isinstance(value, bool):
        return kind == "boolean"
    if kind == "integer" and isinstance(value, float):
        return value.is_integer()  # 5.0 is a whole number in JSON Schema
    return isinstance(value, TYPES[kind])


def problem_with(value: Any, schema: dict[str, Any], name: str = "arguments") -> str | None:
    """Why a value doesn't fit a schema; None: it does. Of JSON Schema what the tools use."""
    kinds = schema.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if kinds and not any(_is_a(value, kind) for kind in kinds):
        return f"{name} must be of type {' or '.join(kinds)}"
    if "enum" in schema and value not in schema["enum"]:
        return f"{name} must be one of {', '.join(map(str, schema['enum']))}"
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        if "minimum" in schema and value < schema["minimum"]:
            return f"{name} must be at least {schema['minimum']}"
        if "exclusiveMinimum" in schema and value <= schema["exclusiveMinimum"]:
            return f"{name} must be greater than {schema['exclusiveMinimum']}"
        if "maximum" in schema and value > schema["maximum"]:
            return f"{name} must be at most {schema['maximum']}"
    if isinstance(value, dict):
        properties = schema.get("properties", {})
        for field in schema.get("required", []):
            if field not in value:
                return f"{name} must have the field \"{field}\""
        for field, each in value.items():
            if field in properties:
                if problem := problem_with(each, properties[field], field):
                    return problem
            elif schema.get("additionalProperties") is False:
                return f"{name} has no field \"{field[:80]}\"; the fields are {', '.join(properties) or 'none'}"
    return None


def with_whole_numbers(arguments: dict[str, Any], schema: dict[str, Any]) -> dict[str, Any]:
    """Arguments that fit the schema, with whole numbers in place of those like 5.0 where it asks for them."""
    whole = {name for name, each in schema["properties"].items() if each["type"] == "integer"}
    return {name: int(value) if name in whole else value for name, value in arguments.items()}


def _shorter(value: Any, entries: int) -> Any:
    """With at most so many entries of each list; a list that was longer is followed by NAME_left_out in its object."""
    if isinstance(value, str):
        return value if len(value) <= MAX_TEXT else value[:MAX_TEXT] + "…"
    if isinstance(value, list):
        return [_shorter(each, entries) for each in value[:entries]]
    if isinstance(value, dict):
        short: dict[str, Any] = {}
        for number, (key, each) in enumerate(value.items()):
            if number == max(entries, 50):
                short["fields_left_out"] = len(value) - number
                break
            short[key] = _shorter(each, entries)
            if isinstance(each, list) and len(each) > entries:
                short[key + "_left_out"] = len(each) - entries
        return short
    return value


def fitted(answer: dict[str, Any]) -> tuple[str, dict[str, Any]]:
    """An answer as text of at most MAX_ANSWER characters, and the same as an object."""
    for entries in (1000, 300, 100, 30, 10, 3, 0):
        short = _shorter(answer, entries)
        text = json.dumps(short, allow_nan=False)
        if len(text) <= MAX_ANSWER:
            return text, short
    short = {"left_out": "the answer is too large to be shown"}
    return json.dumps(short), short
