"""The Unicode bidirectional algorithm (UAX #9): embedding levels of a paragraph, and the visual order of a line.

It is here because the Python packages for it return a reordered string: shaping needs the levels.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from unicodedata import bidirectional, category, normalize

from fontTools.unicodedata.Mirrored import MIRRORED

DEEPEST = 125
"""max_depth of UAX #9, BD2."""

TURNING = frozenset({"R", "AL", "AN", "RLE", "RLO", "RLI", "LRE", "LRO", "LRI", "FSI"})
"""The classes without which all of a paragraph that begins at level 0 is at level 0."""

ISOLATES, EMBEDDINGS = frozenset({"LRI", "RLI", "FSI"}), frozenset({"LRE", "RLE", "LRO", "RLO"})
REMOVED = EMBEDDINGS | {"PDF", "BN"}
NEUTRAL = ISOLATES | {"B", "S", "WS", "ON", "PDI"}

BRACKETS = {chr(a): chr(b) for a, b in MIRRORED.items() if category(chr(a)) == "Ps"}
"""Opening to closing bracket: Bidi_Paired_Bracket."""

CLOSING = {normalize("NFC", a): normalize("NFC", b) for a, b in BRACKETS.items()}
"""The same, canonical equivalents as one."""

PAIRED = frozenset(BRACKETS) | frozenset(BRACKETS.values())


def paragraph_level(classes: Sequence[str]) -> int:
    """Rules P2 and P3: 1 if the first strong character outside isolates runs from right to left, else 0."""
    depth = 0
    for kind in classes:
        if kind in ISOLATES:
            depth += 1
        elif kind == "PDI":
            depth = max(depth - 1, 0)
        elif depth == 0 and kind in ("L", "R", "AL"):
            return int(kind != "L")
    return 0


def embedding_levels(text: str, base: int | None = None) -> tuple[int, list[int]]:
    """The level of a paragraph, and that of each of its characters, by all rules but L1, which is a line's.

    Args:
        text: without paragraph separators, but at its end. base: level of the paragraph; None: rules P2 and P3.

    Returns:
        The paragraph's level and n levels, odd where text runs from right to left. Characters that rule X9 removes have
        the level of the one before.
    """
    by_character = {character: bidirectional(character) or "L" for character in set(text)}
    if not base and TURNING.isdisjoint(by_character.values()):
        return 0, [0] * len(text)
    classes = [by_character[character] for character in text]
    base = paragraph_level(classes) if base is None else base
    matching = _isolates(classes)
    levels, kinds = _explicit(classes, base, matching)
    for sequence, sos, eos in _sequences(classes, levels, base, matching):
        _weak(sequence, kinds, sos)
        _neutral(sequence, kinds, "LR"[levels[sequence[0]] % 2], sos, eos, text, classes)
        for i in sequence:  # rules I1 and I2
            odd = levels[i] % 2
            levels[i] += int(kinds[i] != "R") if odd else {"L": 0, "R": 1}.get(kinds[i], 2)
    for i, kind in enumerate(classes):
        if kind in REMOVED:
            levels[i] = levels[i - 1] if i else base
        elif kind == "B":
            levels[i] = base
    return base, levels


def visual_order(levels: Sequence[int]) -> list[int]:
    """Rule L2: the numbers of a line's runs, or characters, from left to right."""
    order = list(range(len(levels)))
    odd = [level for level in levels if level % 2]
    for level in range(max(levels, default=0), min(odd, default=DEEPEST + 2) - 1, -1):
        is_high = [own >= level for own in levels]
        stretches = [(high, list(those)) for high, those in groupby(order, is_high.__getitem__)]
        order = [i for high, those in stretches for i in (those[::-1] if high else those)]
    return order


def _isolates(classes: Sequence[str]) -> dict[int, int]:
    """BD9: isolate initiator to its PDI."""
    matching, open_ones = {}, []
    for i, kind in enumerate(classes):
        if kind in ISOLATES:
            open_ones.append(i)
        elif kind == "PDI" and open_ones:
            matching[open_ones.pop()] = i
    return matching


def _explicit(classes: Sequence[str], base: int, matching: dict[int, int]) -> tuple[list[int], list[str]]:
    """Rules X1 to X8: levels, and the classes after overrides."""
    levels, kinds = [base] * len(classes), list(classes)
    stack: list[tuple[int, str, bool]] = [(base, "", False)]  # level, override, isolate
    isolates_over = embeddings_over = isolates = 0
    for i, kind in enumerate(classes):
        if kind == "PDI":
            if isolates_over:
                isolates_over -= 1
            elif isolates:
                embeddings_over = 0
                while not stack.pop()[2]:
                    pass
                isolates -= 1
        level, override, isolate = stack[-1]
        if kind != "B":
            levels[i] = level
            if override and kind not in REMOVED:
                kinds[i] = override
        if kind in EMBEDDINGS or kind in ISOLATES:
            if kind == "FSI":
                kind = "RLI" if paragraph_level(classes[i + 1 : matching.get(i, len(classes))]) else "LRI"
            new = (level + 1) | 1 if kind[0] == "R" else (level + 2) & ~1
            isolate = kind in ISOLATES
            if new <= DEEPEST and not isolates_over and not embeddings_over:
                isolates += isolate
                stack.append((new, {"RLO": "R", "LRO": "L"}.get(kind, ""), isolate))
            elif isolate:
                isolates_over += 1
            elif not isolates_over:
                embeddings_over += 1
        elif kind == "PDF" and not isolates_over:
            if embeddings_over:
                embeddings_over -= 1
            elif not isolate and len(stack) > 1:
                stack.pop()
    return levels, kinds


def _sequences(
    classes: Sequence[str], levels: Sequence[int], base: int, matching: dict[int, int]
) -> list[tuple[list[int], str, str]]:
    """BD13 and X10: isolating run sequences, each with sos and eos. Removed characters (X9) are in none."""
    kept = [i for i, kind in enumerate(classes) if kind not in REMOVED and kind != "B"]
    runs = {run[0]: run for run in (list(group) for _, group in groupby(kept, levels.__getitem__))}
    continued = {matching[run[-1]] for run in runs.values() if run[-1] in matching}
    before = dict(zip(kept, [base, *(levels[i] for i in kept)], strict=False))
    after = dict(zip(kept, [*(levels[i] for i in kept[1:]), base], strict=False))
    found = []
    for start, sequence in runs.items():
        if start not in continued:
            while sequence[-1] in matching:
                sequence = sequence + runs[matching[sequence[-1]]]
            end, level = sequence[-1], levels[start]
            last = base if classes[end] in ISOLATES else after[end]
            found.append((sequence, "LR"[max(level, before[start]) % 2], "LR"[max(level, last) % 2]))
    return found


def _weak(sequence: Sequence[int], kinds: list[str], sos: str) -> None:
    """Rules W1 to W7."""
    before = strong = sos
    for i in sequence:  # W1, W2 and W3
        if kinds[i] == "NSM":
            kinds[i] = "ON" if before in ISOLATES or before == "PDI" else before
        before = kinds[i]
        strong = before if before in ("L", "R", "AL") else strong
        if before == "EN" and strong == "AL":
            kinds[i] = "AN"
        elif before == "AL":
            kinds[i] = "R"
    for a, i, b in zip(sequence, sequence[1:], sequence[2:], strict=False):  # W4
        if kinds[a] == kinds[b] and (kinds[i], kinds[a]) in (("ES", "EN"), ("CS", "EN"), ("CS", "AN")):
            kinds[i] = kinds[a]
    for numbers, group in groupby(sequence, lambda i: kinds[i] in ("ET", "EN")):  # W5
        those = list(group)
        if numbers and any(kinds[i] == "EN" for i in those):
            for i in those:
                kinds[i] = "EN"
    strong = sos
    for i in sequence:
        if kinds[i] in ("ES", "CS", "ET"):  # W6
            kinds[i] = "ON"
        elif kinds[i] in ("L", "R"):
            strong = kinds[i]
        elif kinds[i] == "EN" and strong == "L":  # W7
            kinds[i] = "L"


def _neutral(
    sequence: Sequence[int], kinds: list[str], along: str, sos: str, eos: str, text: str, classes: Sequence[str]
) -> None:
    """Rules N0 to N2; ``along`` is the direction of the sequence's level."""
    for a, b in _bracket_pairs(sequence, kinds, text):  # N0
        inside = {_strong(kinds[i]) for i in sequence[a + 1 : b]}
        if not any(inside):
            continue
        before = next((kind for i in reversed(sequence[:a]) if (kind := _strong(kinds[i]))), sos)
        found = along if along in inside else before
        for k in (a, b):
            kinds[sequence[k]] = found
            for i in sequence[k + 1 :]:
                if classes[i] != "NSM":
                    break
                kinds[i] = found
    before, k = sos, 0
    for neutral, group in groupby(sequence, lambda i: kinds[i] in NEUTRAL):
        those = list(group)
        k += len(those)
        if neutral:  # N1 and N2
            after = _strong(kinds[sequence[k]]) if k < len(sequence) else eos
            for i in those:
                kinds[i] = before if before == after else along
        else:
            before = _strong(kinds[those[-1]])


def _strong(kind: str) -> str:
    """The direction of a class for the neutrals beside it, where numbers run from right to left; "" if it has none."""
    return "L" if kind == "L" else "R" if kind in ("R", "EN", "AN") else ""


def _bracket_pairs(sequence: Sequence[int], kinds: Sequence[str], text: str) -> list[tuple[int, int]]:
    """BD16: places of matching brackets in the sequence, by the opening one."""
    if PAIRED.isdisjoint(text):
        return []
    pairs, open_ones = [], list[tuple[str, int]]()
    for k, i in enumerate(sequence):
        if text[i] not in PAIRED or kinds[i] != "ON":
            continue
        character = normalize("NFC", text[i])
        if character in CLOSING:
            if len(open_ones) == 63:
                return []
            open_ones.append((CLOSING[character], k))
        elif (depth := max((d for d, (closing, _) in enumerate(open_ones) if closing == character), default=-1)) >= 0:
            pairs.append((open_ones[depth][1], k))
            del open_ones[depth:]
    return sorted(pairs)
