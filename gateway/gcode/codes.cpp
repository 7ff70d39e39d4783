#include "gateway/gcode/codes.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace kinebus::gcode {
namespace {

// Progress, timers, keep-alive, reports by time, probes, levelling, sounds, pressure advance, driver
// currents, object labels, version checks: they tell or tune what other machines have, and leave the job's
// meaning as it is.
constexpr std::array kHarmlessM = {73,  75,  76,  77,  78,  111, 113, 155, 211, 300, 302, 412,
                                   413, 420, 486, 555, 572, 593, 862, 900, 906, 907, 914};
constexpr std::array kHarmlessG = {290};

struct Reason {
  int code;
  const char* text;
};
constexpr std::array<Reason, 10> kGReasons = {{
    {50, phrase("splines (G5) are not supported: use G1, G2 or G3")},
    {300,
     phrase("G30 means a probe to printers and a stored position to mills: use G53 G0 with coordinates")},
    {301, phrase("G30.1 is not supported: use G10 L2 or parameters")},
    {410, phrase("cutter compensation (G41) is not supported: offset the path in CAM")},
    {420, phrase("cutter compensation (G42) is not supported: offset the path in CAM")},
    {380, phrase("probing (G38) is not supported")},
    {382, phrase("probing (G38.2) is not supported")},
    {680, phrase("G68 is not supported: use G68.2 for a tilted plane")},
    {683, phrase("G68.3 is not supported: use G68.2 with I J K")},
    {950, phrase("feed for each turn (G95) needs a spindle, which this machine does not have")},
}};
constexpr std::array<Reason, 6> kMReasons = {{
    {3, phrase("M3 turns a spindle, which this machine does not have")},
    {4, phrase("M4 turns a spindle, which this machine does not have")},
    {6, phrase("M6 changes tools, which this machine cannot")},
    {7, phrase("M7 switches coolant, which this machine does not have")},
    {8, phrase("M8 switches coolant, which this machine does not have")},
    {92, phrase("M92 changes steps for each mm: they belong to the machine file")},
}};

}  // namespace

MGroup m_group(int number) {
  switch (number) {
    case 0:
    case 1:
    case 2:
    case 30:
      return MGroup::kStop;
    case 82:
    case 83:
      return MGroup::kExtrusion;
    case 17:
    case 18:
    case 84:
      return MGroup::kMotors;
    case 104:
    case 109:
      return MGroup::kHotend;
    case 140:
    case 190:
      return MGroup::kBed;
    case 141:
    case 191:
      return MGroup::kChamber;
    case 106:
    case 107:
      return MGroup::kFan;
    case 105:
    case 114:
    case 115:
    case 119:
      return MGroup::kQuery;
    case 500:
    case 501:
    case 502:
    case 503:
      return MGroup::kSettings;
    case 3:
    case 4:
    case 5:
      return MGroup::kSpindle;
    case 9:
    case 42:
    case 110:
    case 112:
    case 117:
    case 118:
    case 201:
    case 203:
    case 204:
    case 205:
    case 207:
    case 208:
    case 220:
    case 221:
    case 400:
      return MGroup::kOther;
    default:
      break;
  }
  if (number >= 20 && number <= 32) return MGroup::kJobs;
  if (std::find(kHarmlessM.begin(), kHarmlessM.end(), number) != kHarmlessM.end()) return MGroup::kHarmless;
  return MGroup::kUnknown;
}

bool takes_text(int m_number) {
  switch (m_number) {
    case 23:
    case 28:
    case 29:
    case 30:
    case 32:
    case 117:
    case 118:
      return true;
    default:
      return m_group(m_number) == MGroup::kHarmless;
  }
}

bool harmless_g(int tenths) {
  return std::find(kHarmlessG.begin(), kHarmlessG.end(), tenths) != kHarmlessG.end();
}

std::string g_name(int tenths) {
  std::string name("G");
  name += std::to_string(tenths / 10);
  if (tenths % 10 != 0) (name += '.') += std::to_string(tenths % 10);
  return name;
}

std::string m_name(int number) {
  std::string name("M");
  name += std::to_string(number);
  return name;
}

Sentence unknown_g(int tenths) {
  for (const Reason& reason : kGReasons)
    if (reason.code == tenths) return say(reason.text);
  if (tenths >= 810 && tenths <= 890)
    return say("canned cycles (%1) are not supported: use G0 and G1", g_name(tenths));
  return say("%1 is unknown", g_name(tenths));
}

Sentence unknown_m(int number) {
  for (const Reason& reason : kMReasons)
    if (reason.code == number) return say(reason.text);
  return say("%1 is unknown", m_name(number));
}

}  // namespace kinebus::gcode
