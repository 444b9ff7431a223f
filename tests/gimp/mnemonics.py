#!/usr/bin/env python3
"""Within a dialog no letter is a mnemonic twice, in any language, GIMP's own buttons included.

mnemonics.py HOST PROJECT: the messages come from po/, GIMP's from its installed catalogues.
"""
import gettext
import re
import sys
from pathlib import Path

from host import Tap

# Every message with a mnemonic is in both dialogs, but for these; an ellipsis ends a menu's.
ONLY_FILL = {"Cop_y from", "_Goes into"}
ONLY_TEXTURE = {"_Width", "Hei_ght"}
GIMPS = {"2": ("gimp20-libgimp", ["_Help"]),
         "3": ("gimp30-libgimp", ["_Help", "_Reset", "_Cancel", "_OK", "_Load Saved Settings",
                                  "_Save Settings"])}


def messages(path):
    """msgid -> (where it is used, msgstr)."""
    found = {}
    for entry in path.read_text().split("\n\n"):
        text = {}
        for kind, quoted in re.findall(r'^(msgid|msgstr) ((?:".*"\n?)+)', entry + "\n", re.M):
            text[kind] = "".join(re.findall(r'"(.*)"', quoted))
        found[text["msgid"]] = (re.findall(r"^#: (.*)", entry, re.M), text["msgstr"])
    return found


def mnemonic(text):
    match = re.search(r"_(.)", text)
    return match and match[1].upper()


def ours(host, catalogue, translated):
    other = "plugin/gimp3/" if host == "2" else "plugin/gimp2/"
    for text, (places, translation) in catalogue.items():
        files = " ".join(places).split()
        if mnemonic(text) and not text.endswith("…") and any(other not in file for file in files):
            yield text, mnemonic(translation if translated else text)


def gimps(host, language):
    domain, texts = GIMPS[host]
    catalogue = gettext.translation(domain, "/usr/share/locale", [language], fallback=True)
    return {mnemonic(catalogue.gettext(text)) for text in texts}


def twice(letters, taken):
    """The texts whose letter another has, or none at all."""
    seen = dict.fromkeys(taken, "GIMP's own")
    for text, letter in letters:
        if letter is None:
            yield f"{text}: has none"
        elif letter in seen:
            yield f"{text}: {letter} is {seen[letter]}'s"
        seen[letter] = text


def main():
    host, project = sys.argv[1], Path(sys.argv[2])
    tap = Tap()
    languages = [line for line in (project / "po/LINGUAS").read_text().split()
                 if line.isidentifier()]
    tap.case(len(messages(project / "po/recede.pot")) > 50, "the template is read")
    for language in ["C", *(name for name in languages if (project / f"po/{name}.po").exists())]:
        path = project / "po" / ("recede.pot" if language == "C" else f"{language}.po")
        letters = list(ours(host, messages(path), language != "C"))
        for name, others in (("fill", ONLY_TEXTURE), ("texture", ONLY_FILL)):
            wrong = list(twice([each for each in letters if each[0] not in others],
                               gimps(host, language)))
            tap.case(len(letters) > 10 and not wrong, f"{language}: {name}", "\n".join(wrong))
    tap.plan()


main()
