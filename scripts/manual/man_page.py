"""Writes a man page from a program's help and from sections written by hand."""
import re

from help_text import listed_words


DOCUMENTS = "/usr/share/doc/prismesh/"


def escaped(text):
    text = text.replace("\\", "\\e").replace("docs/", DOCUMENTS)
    return "\\&" + text if text.startswith((".", "'")) else text


def sentence(text):
    """Begins with a capital letter, unless the first word is a name or a value, and ends with a full stop."""
    text = text.strip()
    first = text.split(" ")[0]
    if re.fullmatch(r"[a-z]+", first.rstrip(",.:;")) and first.rstrip(",") not in listed_words(text):
        text = text[0].upper() + text[1:]
    return text if text.endswith(".") else text + "."


def bold(text):
    return "\\fB" + text.replace("\\", "\\e").replace("-", "\\-") + "\\fR"


def italic(text):
    return "\\fI" + text.replace("\\", "\\e").replace("-", "\\-") + "\\fR"


def running_text(text):
    """Options and `quoted` commands in a sentence are bold."""
    def mark(match):
        return match.group(1) + bold(match.group(2))
    text = escaped(text)
    text = re.sub(r"`([^`]*)`", lambda m: bold(m.group(1)), text)
    return re.sub(r"(^|[ (])(--[a-z][a-z-]*)", mark, text)


def usage(text):
    """Names are bold, what stands for something else is italic."""
    def mark(word):
        inner = word.strip("[].")
        if re.fullmatch(r"[A-Z|]+", inner):
            return word.replace(inner, italic(inner))
        return word.replace(inner, bold(inner)) if inner.startswith("-") or inner.islower() else word
    return " ".join(mark(word) for word in text.split())


def entry(each, is_option):
    head = ", ".join(bold(name) for name in each.names) if is_option else italic(each.names[0])
    if is_option and each.value:
        head += " " + (bold(each.value) if each.choices else italic(each.value))
    text = sentence(each.text)
    if each.repeated and "may be repeated" not in text:
        text += " May be repeated."
    if is_option and each.required:
        text += " Required."
    if each.excludes:
        text += " Not together with " + " or ".join(each.excludes) + "."
    return [".TP", head, running_text(text)]


def command_section(command):
    """The arguments and options of a command below the program, without --help."""
    lines = ['.SS "' + " ".join(command.path).replace("-", "\\-") + '"']
    if not command.commands:
        lines += [usage(command.usage), ".PP"]
    lines.append(running_text(sentence(command.what)))
    for each in command.arguments:
        lines += entry(each, False)
    for each in command.options:
        if "--help" not in each.names:
            lines += entry(each, True)
    return lines


def page(command, *, section, version, date, what, by_hand):
    """`what` is the line of NAME; `by_hand` the text of further sections. The first of these is the DESCRIPTION, without its heading."""
    name = command.path[0]
    lines = [f'.\\" Generated from the text of {name} --help and scripts/manual/sections.',
             f'.TH {name.upper()} {section} "{date}" "Prismesh {version}" "Prismesh"', ".nh", ".ad l",
             ".SH NAME", f"{name} \\- {what}", ".SH SYNOPSIS"]
    if command.commands:
        lines += [bold(name) + " [" + italic("OPTIONS") + "] " + italic("COMMAND") + " ..."]
    else:
        lines += [usage(command.usage)]
    description, _, rest = by_hand.partition("\n.SH ")
    lines += [".SH DESCRIPTION", description.strip()]
    lines += [".SH OPTIONS"]
    if command.commands:
        lines += ["They may stand before or after the command."]
    for each in command.options:
        lines += entry(each, True)
    if command.closing:
        lines += [".PP", running_text(command.closing)]
    if command.commands:
        lines += [".SH COMMANDS"]
        for below in command.commands:
            for each in below.walk():
                lines += command_section(each)
    if rest:
        lines += [".SH " + rest.strip()]
    return "\n".join(lines) + "\n"
