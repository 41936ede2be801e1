"""Shells that complete rotctl's words: `completion`."""

import argparse
import shlex

from rotctl.cli.commands.arguments import Commands
from rotctl.errors import InputError

# Each asks for the words of the line so far. What ends in `=` or `.` goes on, so that no blank
# follows it; where there is nothing the shell completes files.
SCRIPTS = {
    "bash": """\
_rotctl() {
  local line="${COMP_LINE:0:COMP_POINT}" word cut
  word="${line##* }"
  cut="${word%"${word##*[=]}"}"  # bash puts in what comes after a `=`
  COMPREPLY=()
  while IFS= read -r found; do
    case "$found" in *[=.]) ;; *) found="$found " ;; esac
    COMPREPLY+=("${found#"$cut"}")
  done < <(rotctl completion words "$line" 2>/dev/null)
}
complete -o default -o nospace -F _rotctl rotctl
""",
    "zsh": """\
#compdef rotctl
_rotctl() {
  local -a found
  found=("${(@f)$(rotctl completion words "${(j: :)words[1,CURRENT]}" 2>/dev/null)}")
  found=(${found:#})
  if (( ${#found} )); then
    compadd -Q -S '' -- ${(M)found:#*[=.]}
    compadd -Q -- ${found:#*[=.]}
  else
    _files
  fi
}
compdef _rotctl rotctl
""",
    "fish": """\
function __rotctl_words
  rotctl completion words (commandline -cp) 2>/dev/null
end
complete -c rotctl -a '(__rotctl_words)'
""",
}


def add_completion(commands: Commands) -> None:
    """Add `completion`."""
    command = commands.add_parser(
        "completion",
        help="a shell that completes commands, choices and keys",
        description="Print a script for a shell. bash: source <(rotctl completion bash); zsh: "
        "source <(rotctl completion zsh); fish: rotctl completion fish | source. Then the tab "
        "key completes commands, options, behaviours and other choices, and keys of the config.",
    )
    command.add_argument(
        "shell", choices=[*SCRIPTS, "words"], help="words: what can follow LINE, for those scripts"
    )
    command.add_argument("line", nargs="?", default="", metavar="LINE")
    command.set_defaults(command=completion)


def completion(arguments: argparse.Namespace) -> int:
    """Print a script, or the words that can follow a line."""
    if arguments.shell in SCRIPTS:
        if arguments.line:
            raise InputError(f"LINE is for rotctl completion words, not for {arguments.shell}")
        print(SCRIPTS[arguments.shell], end="")
        return 0
    from rotctl.cli.completing import candidates

    for word in candidates(_words(arguments.line), arguments.commands):
        print(word)
    return 0


def _words(line: str) -> list[str]:
    """The words of a line after the program's; the last one is empty after a blank."""
    try:
        words = shlex.split(line)
    except ValueError:  # a quotation that has only begun
        words = line.split()
    return words[1:] + [""] * (not words[1:] or line[-1:].isspace())
