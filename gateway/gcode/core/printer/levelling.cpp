// Levelling of the bed: G29, G30, M420, M421, M374, M375, M561 and Klipper's BED_MESH_ words. A line gives
// out the moves and probes of the whole grid; what they find is the machine's mesh at their end.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/letters.hpp"
#include "gateway/gcode/number.hpp"

namespace kinebus::gcode {
namespace {

using Mesh = canonical::Mesh;

constexpr std::size_t kLongestName = 60;
constexpr std::string_view kStandardName = "default";

/// G29's words: letters with a number, a text in quotation marks, or nothing.
class TextWords {
 public:
  explicit TextWords(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
      const char letter = in_lower_case(text[at++]);
      if (letter == '(') break;
      if (letter < 'a' || letter > 'z') continue;
      const auto place = static_cast<std::size_t>(letter - 'a');
      given_[place] = true;
      if (at < text.size() && text[at] == '"') {
        const std::size_t close = std::min(text.find('"', at + 1), text.size());
        name_ = std::string(text.substr(at + 1, close - at - 1));
        at = std::min(close + 1, text.size());
        continue;
      }
      double value = 0;
      const char* const after = parse_decimal(text.data() + at, text.data() + text.size(), value);
      if (after == nullptr) continue;
      values_[place] = value;
      at = static_cast<std::size_t>(after - text.data());
    }
  }
  bool has(char letter) const { return given_[static_cast<std::size_t>(letter - 'a')]; }
  std::optional<double> value(char letter) const { return values_[static_cast<std::size_t>(letter - 'a')]; }
  std::string name() const { return name_.empty() ? std::string(kStandardName) : name_; }

 private:
  std::array<bool, 26> given_{};
  std::array<std::optional<double>, 26> values_{};
  std::string name_;
};

}  // namespace

bool Core::note_no_levelling(int code, const std::string& name) {
  note(kNoteForMesh + code,
       options_.probe == ProbeFitted::kNone
           ? say("%1 has no effect: the machine file has no [probe]", name)
           : say("%1 has no effect: a probe with where = \"simulated\" cannot touch", name));
  return true;
}

bool Core::mesh_command(std::uint32_t column, Mesh command) {
  if (command.name.size() > kLongestName)
    return fail(column, say("a mesh's name has %1 letters at most", kLongestName));
  if (state_.modal.tilted)
    return fail(column, say("%1 cannot be used in a tilted plane: end it with G69 first", "M420"));
  emit(std::move(command));
  return true;
}

/// The grid over the bed, or over the area given (canonical X and Y): the moves, the probes and the mesh.
bool Core::measure_mesh(std::uint32_t column, std::string name, const MeshArea& area) {
  ModalState& m = state_.modal;
  const MeshOptions& o = options_.mesh;
  const std::string code = "G29";
  if (name.size() > kLongestName)
    return fail(column, say("a mesh's name has %1 letters at most", kLongestName));
  if (m.tilted) return fail(column, say("%1 cannot be used in a tilted plane: end it with G69 first", code));
  if (is_turned()) return fail(column, say("%1 cannot be used in a turned coordinate system (G10 R)", code));
  if (m.left_out || m.away) return fail(column, say("%1 cannot be used while an object is left out", code));
  if (std::abs(m.position[kAxisA]) > kNoMotion || std::abs(m.position[kAxisC]) > kNoMotion)
    return fail(column, say("%1 needs A and C at 0", code));
  Mesh mesh{.what = Mesh::What::kBegin, .name = std::move(name)};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    mesh.from_mm[axis] = std::max(area.from_mm[axis].value_or(o.from_mm[axis]), o.from_mm[axis]);
    mesh.to_mm[axis] = std::min(area.to_mm[axis].value_or(o.to_mm[axis]), o.to_mm[axis]);
    mesh.points[axis] = area.points[axis] > 0 ? area.points[axis] : o.points[axis];
    if (area.adaptive) {
      const double share = (mesh.to_mm[axis] - mesh.from_mm[axis]) / (o.to_mm[axis] - o.from_mm[axis]);
      mesh.points[axis] = std::max(3, static_cast<int>(std::ceil(mesh.points[axis] * share)));
    }
    if (!(mesh.to_mm[axis] - mesh.from_mm[axis] >= 1))
      return fail(column,
                  say("the area to be probed lies outside of [mesh] of the machine file: %1 is %2 to %3 mm",
                      std::string(1, kAxisLetters[axis]), printed("%.6g", o.from_mm[axis]),
                      printed("%.6g", o.to_mm[axis])));
    if (mesh.points[axis] < 2 || mesh.points[axis] > Mesh::kMostPoints)
      return fail(column, say("a mesh has 2 to %1 points along an axis", Mesh::kMostPoints));
  }
  emit(mesh);
  Pose at = m.position;
  const double clear = o.lift_mm - options_.probe_offset_mm[2];
  at[kAxisZ] = std::max(at[kAxisZ], clear);
  emit(canonical::Traverse{at, m.frame});
  for (int row = 0; row < mesh.points[1]; ++row)
    for (int step = 0; step < mesh.points[0]; ++step) {
      // There and back, row by row.
      const int column_at = row % 2 == 0 ? step : mesh.points[0] - 1 - step;
      const auto place = [&](std::size_t axis, int i) {
        return mesh.from_mm[axis] + (mesh.to_mm[axis] - mesh.from_mm[axis]) * i / (mesh.points[axis] - 1) -
               options_.probe_offset_mm[axis];
      };
      at[kAxisX] = place(0, column_at);
      at[kAxisY] = place(1, row);
      probe_down(at, clear);
      at[kAxisZ] = clear;
    }
  see_pin_in();
  mesh.what = Mesh::What::kEnd;
  emit(mesh);
  m.position = at;
  refresh();
  probe_goes_on_ = true;
  return true;
}

/// Over the place at a height, down, and up again to `clear`.
void Core::probe_down(Pose at, double clear) {
  const Frame frame = state_.modal.frame;
  emit(canonical::Traverse{at, frame});
  if (at[kAxisZ] > clear) {
    at[kAxisZ] = clear;
    emit(canonical::Traverse{at, frame});
  }
  Pose down = at;
  down[kAxisZ] = -options_.mesh.depth_mm - options_.probe_offset_mm[2];
  emit(canonical::Probe{down, frame, options_.probe_mm_per_s, false, true});
  at[kAxisZ] = clear;
  emit(canonical::Traverse{at, frame});
}

/// Lifted: what was drawn in on the bed may have been held in by the bed.
void Core::see_pin_in() {
  if (options_.probe_pin) emit(canonical::ProbePin{canonical::ProbePin::What::kIn});
}

bool Core::level_bed() {
  const std::uint32_t column = block_.code(GGroup::kNonmodal).column;
  const TextWords words(block_.text);
  const bool rrf = state_.modal.dialect == Dialect::kRepRapFirmware;
  const auto s = words.value('s');
  if (rrf && s && *s > 0) {
    Mesh command{.what = *s == 1   ? Mesh::What::kOn
                         : *s == 2 ? Mesh::What::kOff
                                   : Mesh::What::kKeep,
                 .name = words.name()};
    return mesh_command(column, std::move(command));
  }
  const auto p = words.value('p');
  if (!rrf && words.has('a')) return mesh_command(column, {.what = Mesh::What::kOn});
  // P0 to P9 are phases: 1 probes, the others edit what it has found. C goes on with what is there.
  if (!rrf && ((p && std::floor(*p) != 1) || words.has('c') || words.has('j') || words.has('t'))) {
    note(kNoteForMesh + 29,
         say("%1 of this form has no effect: G29 alone, or P1, probes the whole bed", "G29"));
    return true;
  }
  if (options_.probe != ProbeFitted::kFitted) return note_no_levelling(290, "G29");
  MeshArea area;
  const auto bound = [&](char letter, std::optional<double>& to, std::size_t axis) {
    if (const auto value = words.value(letter)) to = length(*value) + shift_[axis];
  };
  if (!rrf && words.has('w') && words.has('h')) {
    bound('x', area.from_mm[0], 0);
    bound('y', area.from_mm[1], 1);
    for (std::size_t axis = 0; axis < 2; ++axis)
      if (const auto size = words.value(axis == 0 ? 'w' : 'h'); size && area.from_mm[axis])
        area.to_mm[axis] = *area.from_mm[axis] + length(*size);
  } else if (!rrf && words.has('l') && words.has('r') && words.has('f') && words.has('b')) {
    bound('l', area.from_mm[0], 0);
    bound('r', area.to_mm[0], 0);
    bound('f', area.from_mm[1], 1);
    bound('b', area.to_mm[1], 1);
  }
  return measure_mesh(column, std::string(kStandardName), area);
}

/// G30: one place, told; RepRapFirmware gives it the height 0, too.
bool Core::probe_once(Code code) {
  ModalState& m = state_.modal;
  if (options_.spindle)
    return fail(code.column,
                say("G30 means a probe to printers and a stored position to mills: keep one with "
                    "G30.1 before it, or use G53 G0 with coordinates"));
  const bool rrf = m.dialect == Dialect::kRepRapFirmware;
  Pose program = m.program;
  program_target(program);
  program[kAxisZ] = m.program[kAxisZ];
  const bool deltas = block_.has('P') || (block_.has('S') && !rrf);
  for (char letter = 'A'; letter <= 'Z'; ++letter)
    if (letter != 'F') pass_over(letter);
  if (options_.probe != ProbeFitted::kFitted) return note_no_levelling(300, "G30");
  if (deltas) {
    note(kNoteForMesh + 300, say("%1 has no effect on this machine", "G30 P"));
    return true;
  }
  if (!refuse_in_tilt(code)) return false;
  if (is_turned())
    return fail(code.column, say("%1 cannot be used in a turned coordinate system (G10 R)", "G30"));
  if (m.left_out || m.away)
    return fail(code.column, say("%1 cannot be used while an object is left out", "G30"));
  if (std::abs(m.position[kAxisA]) > kNoMotion || std::abs(m.position[kAxisC]) > kNoMotion)
    return fail(code.column, say("%1 needs A and C at 0", "G30"));
  Pose at = m.position;
  if (block_.has('X')) at[kAxisX] = program[kAxisX] + shift_[kAxisX] - options_.probe_offset_mm[0];
  if (block_.has('Y')) at[kAxisY] = program[kAxisY] + shift_[kAxisY] - options_.probe_offset_mm[1];
  const double clear = options_.mesh.lift_mm - options_.probe_offset_mm[2];
  if (m.position[kAxisZ] < clear) {
    Pose up = m.position;
    up[kAxisZ] = clear;
    emit(canonical::Traverse{up, m.frame});
  }
  at[kAxisZ] = std::max(at[kAxisZ], clear);
  probe_down(at, clear);
  see_pin_in();
  emit(Mesh{.what = Mesh::What::kTellProbe});
  at[kAxisZ] = clear;
  m.position = at;
  refresh();
  probe_goes_on_ = true;
  probe_sets_z_ = rrf && !block_.has('S');
  return true;
}

/// The line that probed has gone on behind it: where it ends, the tool stands already.
void Core::probe_within(const ProbeResult& result) {
  ModalState& m = state_.modal;
  Pose program = m.program;
  const Pose at = in_frame(result.at, result.frame, m.frame);
  for (const Axis axis : {kAxisX, kAxisY, kAxisZ}) program[axis] = at[axis] - shift_[axis];
  tell_probed(program, result.contact);
  if (!std::exchange(probe_sets_z_, false)) return;
  if (!m.g92_active) m.g92_offset = {};
  m.g92_offset[kAxisZ] += program[kAxisZ] + options_.probe_offset_mm[2];
  m.g92_active = true;
  refresh();
}

bool Core::mesh_code(Code code) {
  const auto value = [&](char letter) -> std::optional<double> {
    if (!block_.has(letter) || block_.is_bare(letter)) return std::nullopt;
    return block_[letter];
  };
  for (char letter = 'A'; letter <= 'Z'; ++letter)
    if (letter != 'F') pass_over(letter);
  const std::string name = m_name(code.number);
  switch (code.number) {
    case 374:
    case 375:
      return mesh_command(code.column, {.what = code.number == 374 ? Mesh::What::kKeep : Mesh::What::kOn,
                                        .name = TextWords(block_.text).name()});
    case 561:
      return mesh_command(code.column, {.what = Mesh::What::kOff});
    case 421: {
      const auto i = value('I'), j = value('J'), z = value('Z'), q = value('Q');
      const auto whole = [](const std::optional<double>& v) {
        return v && *v == std::floor(*v) && *v >= 0 && *v < Mesh::kMostPoints;
      };
      if (!whole(i) || !whole(j) || z.has_value() == q.has_value())
        return fail(code.column,
                    say("M421 needs the point I J, counted from 0, and its height Z, or Q to add to it"));
      Mesh command{.what = Mesh::What::kPoint, .points = {static_cast<int>(*i), static_cast<int>(*j)}};
      command.adds = q.has_value();
      command.value_mm = length(z ? *z : *q);
      return mesh_command(code.column, std::move(command));
    }
    default:
      break;
  }
  if (state_.modal.dialect == Dialect::kRepRapFirmware) {  // lights
    note(kNoteForMesh + 420, say("%1 has no effect on this machine", name));
    return true;
  }
  Mesh command{.what = Mesh::What::kTell};
  if (const auto s = value('S')) command.what = *s != 0 ? Mesh::What::kOn : Mesh::What::kOff;
  if (const auto z = value('Z')) {
    if (*z < 0)
      return fail(block_.column_of('Z'), say("the height over which a mesh fades cannot be negative"));
    command.fade_mm = length(*z);
    if (command.what == Mesh::What::kTell) command.what = Mesh::What::kFade;
  }
  return mesh_command(code.column, std::move(command));
}

/// BED_MESH_CALIBRATE MESH_MIN=10,10 MESH_MAX=200,200 PROBE_COUNT=5,5 ADAPTIVE=1, BED_MESH_PROFILE LOAD=x.
bool Core::mesh_word(const std::string& name, const WordOf& word) {
  const std::uint32_t column = block_.command_column;
  if (name == "bed_mesh_clear") return mesh_command(column, {.what = Mesh::What::kOff});
  if (name == "bed_mesh_output" || name == "bed_mesh_map")
    return mesh_command(column, {.what = Mesh::What::kTell});
  if (name == "bed_mesh_profile") {
    constexpr std::array<std::pair<std::string_view, Mesh::What>, 3> kUses = {
        {{"load", Mesh::What::kOn}, {"save", Mesh::What::kKeep}, {"remove", Mesh::What::kForget}}};
    for (const auto& [key, what] : kUses)
      if (const auto text = word(key))
        return mesh_command(column, {.what = what, .name = std::string(*text)});
    return fail(column, say("%1 needs %2", "BED_MESH_PROFILE", "LOAD=, SAVE= / REMOVE="));
  }
  if (options_.probe != ProbeFitted::kFitted) return note_no_levelling(290, "BED_MESH_CALIBRATE");
  const auto pair = [&](std::string_view key) -> std::optional<std::array<double, 2>> {
    const auto text = word(key);
    if (!text) return std::nullopt;
    std::array<double, 2> both{};
    const char* const end = text->data() + text->size();
    const char* after = parse_decimal(text->data(), end, both[0]);
    if (after == nullptr) return std::nullopt;
    both[1] = both[0];
    if (after != end && *after == ',') static_cast<void>(parse_decimal(after + 1, end, both[1]));
    return both;
  };
  MeshArea area;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (const auto from = pair("mesh_min")) area.from_mm[axis] = (*from)[axis] + shift_[axis];
    if (const auto to = pair("mesh_max")) area.to_mm[axis] = (*to)[axis] + shift_[axis];
    if (const auto count = pair("probe_count"))
      area.points[axis] = static_cast<int>(std::clamp((*count)[axis], -1.0, 1e3));
  }
  const auto adaptive = pair("adaptive");
  if (adaptive && (*adaptive)[0] != 0 && state_.print_area) {
    const auto margin = pair("adaptive_margin");
    const double more = margin ? std::max((*margin)[0], 0.0) : 0;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      area.from_mm[axis] = (*state_.print_area)[axis] + shift_[axis] - more;
      area.to_mm[axis] = (*state_.print_area)[axis + 2] + shift_[axis] + more;
    }
    area.adaptive = true;
  }
  const auto profile = word("profile");
  return measure_mesh(column, std::string(profile.value_or(kStandardName)), area);
}

/// EXCLUDE_OBJECT_DEFINE POLYGON=[[x,y],...] CENTER=x,y: what will be printed.
void Core::add_to_print_area(std::string_view points) {
  std::size_t count = 0;
  double first = 0;
  const char* const end = points.data() + points.size();
  for (const char* p = points.data(); p != end;) {
    double value = 0;
    const char* const after = parse_decimal(p, end, value);
    if (after == nullptr || after == p) {
      ++p;
      continue;
    }
    p = after;
    if (count++ % 2 == 0) {
      first = value;
      continue;
    }
    auto& area = state_.print_area;
    if (!area) area = {first, value, first, value};
    *area = {std::min((*area)[0], first), std::min((*area)[1], value), std::max((*area)[2], first),
             std::max((*area)[3], value)};
  }
}

}  // namespace kinebus::gcode
