"""Writes the completion of bash from a program's help."""
import re

from help_text import listed_words


def completes(entry):
    """What to offer for a value: `words a b`, `files`, `folders`, both words and files, or `none`; empty for a flag."""
    is_option = entry.names[0].startswith("-")
    if is_option and entry.value == "":
        return ""
    if entry.choices:
        return "words " + " ".join(entry.choices)
    if entry.value in ("DIR", "FOLDER") or re.match(r"(the )?folder\b", entry.text, re.IGNORECASE):
        return "folders"
    words = listed_words(entry.text)
    first_clause = re.split(r"[;:]", entry.text)[0]  # the rest says what the value does
    is_file = re.search(r"\b(file|deck|PNG|journal)\b(?!')", first_clause + (" file" if entry.text.endswith("or a file") else ""))
    is_file = entry.value in ("FILE", "DECK", "NAME|FILE", "A", "B") or (is_file and "as JSON" not in first_clause)
    if words:
        return ("words-or-files " if is_file else "words ") + " ".join(words)
    return "files" if is_file else "none"


def commands_case(program):
    lines = []
    for command in program.walk():
        for below in command.commands:
            lines.append(f'      "{" ".join(below.path)}") path="$path $word"; continue ;;')
    return lines


def offers_case(program):
    lines = []
    for command in program.walk():
        offered = list(command.options)
        if command is not program:  # what the program and the commands above take may follow
            above = [each for each in program.walk() if each.path == command.path[:len(each.path)] and each is not command]
            offered += [option for each in above for option in each.options]
        names = dict.fromkeys(name for option in offered for name in option.names if command is program or name != "--version")
        subcommands = " ".join(below.path[-1] for below in command.commands)
        kinds = [completes(each) for each in command.arguments]
        arguments = next((kind for kind in kinds if kind != "none"), "none")
        lines.append(f'    "{" ".join(command.path)}") options="{" ".join(names)}" commands="{subcommands}" arguments="{arguments}" ;;')
    return lines


def values_case(program):
    lines = []
    for command in program.walk():
        for option in command.options:
            kind = completes(option)
            if not kind:
                continue
            inside = "*" if command.commands else ""  # the options of a command with commands may stand behind these
            patterns = "|".join(f'"{" ".join(command.path)}"{inside}" {name}"' for name in option.names)
            lines.append(f'    {patterns}) echo "{kind}" ;;')
    return lines


def bash(program):
    name = program.path[0]
    function = "_" + name.replace("-", "_")
    return "\n".join([
        f"# bash completion for {name}, generated from the text of its --help.",
        "",
        "# What follows an option of a command; nothing after a flag.",
        f"{function}_value() {{",
        '  case "$1 $2" in',
        *values_case(program),
        "  esac",
        "}",
        "",
        f"{function}() {{",
        f'  local current=${{COMP_WORDS[COMP_CWORD]}} path="{name}" word value="" options="" commands="" arguments="" i',
        "  COMPREPLY=()",
        "  for ((i = 1; i < COMP_CWORD; ++i)); do",
        "    word=${COMP_WORDS[i]}",
        f'    value=$({function}_value "$path" "$word")',
        '    if [ -n "$value" ]; then',
        "      [ \"${COMP_WORDS[i + 1]}\" = = ] && ((++i))  # --option=value comes as three words",
        "      ((++i))",
        "      continue",
        "    fi",
        '    case "$path $word" in',
        *commands_case(program),
        "    esac",
        "    value=",
        "  done",
        "  # The value of the option before, if that is where the cursor is.",
        '  [ "$i" -gt "$COMP_CWORD" ] || value=',
        '  [ "$current" = = ] && current=',
        '  case "$path" in',
        *offers_case(program),
        "  esac",
        "  local kind=${value:-$arguments} words=",
        '  if [ -z "$value" ]; then',
        '    words=$commands',
        '    case "$current" in -*) words=$options kind=none ;; esac',
        "  fi",
        '  case "$kind" in words*) words="$words ${kind#* }" ;; esac',
        '  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")',
        "  local names=()",
        '  case "$kind" in',
        '    files | words-or-files*) mapfile -t names < <(compgen -f -- "$current") ;;',
        '    folders) mapfile -t names < <(compgen -d -- "$current") ;;',
        "  esac",
        '  if [ ${#names[@]} -gt 0 ]; then',
        "    compopt -o filenames 2>/dev/null",
        '    COMPREPLY+=("${names[@]}")',
        "  fi",
        "}",
        f"complete -F {function} {name}",
    ]) + "\n"
