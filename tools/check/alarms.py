"""Every code that a node or the gateway can send has its row in the alarm table; used by tools/check/sentences."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
CODES = pathlib.Path("protocol/canopen/alarm_codes.hpp")
TABLE = pathlib.Path("protocol/canopen/alarm_table.hpp")
# Where alarms are raised: a code there has a name of alarm_codes.hpp.
RAISED = ("node_firmware", "gateway")
CALL = re.compile(r"\b(?:raise|report|request_stop|stop_once|on_drive_fault|on_axis_trouble|alarm|fail|trip)\([^;]*?"
                  r"\b(0x[0-9A-Fa-f]{4})\b", re.S)
NAMED = re.compile(r"std::uint16_t [^;{]*= 0x(?:[2-8][0-9A-F]{3}|FF[0-9A-F]{2})\b")


def code_of(path):
    return re.sub(r"//[^\n]*", "", (ROOT / path).read_text())


def literals():
    """What the table says, in its order."""
    text = re.sub(r"(?m)^(?:#include|static_assert).*$", "", code_of(TABLE))
    return ["".join(re.findall(r'"((?:[^"\\]|\\.)*)"', part)) for part in re.findall(r'(?:"(?:[^"\\]|\\.)*"\s*)+', text)]


def wrong():
    found = []
    names = {}
    scope = ""
    for line in code_of(CODES).splitlines():
        if opened := re.match(r"(?:namespace (emcy|node_emcy) \{|enum class (AlarmCode)\b)", line):
            scope = opened[1] or opened[2]
        for name, code in re.findall(r"\b(k\w+) = 0x([0-9A-F]{4})", line):
            names[f"{scope}::{name}"] = code
    rows = re.findall(r"\b((?:emcy|node_emcy|AlarmCode)::k\w+)", code_of(TABLE))
    found += [f"{TABLE}: no row for {name} ({code}h)" for name, code in names.items()
              if name not in rows and name != "emcy::kNoError"]
    for folder in RAISED:
        for path in sorted((ROOT / folder).glob("**/*.[ch]pp")):
            if "tests" in path.parts:
                continue
            text = re.sub(r"//[^\n]*", "", path.read_text())
            for code in CALL.findall(text):
                found.append(f"{path.relative_to(ROOT)}: {code} has no name in {CODES}")
            if "emcy" in text or "fault" in path.name:
                for definition in NAMED.findall(text):
                    found.append(f"{path.relative_to(ROOT)}: a code outside of {CODES}: {definition}")
    return found
