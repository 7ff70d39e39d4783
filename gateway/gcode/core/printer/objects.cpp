// Objects of a print that are left out: M486, EXCLUDE_OBJECT and the comments of slicers. The text goes on
// being read as if they were printed; what it would move is not given out, and the first move that is wanted
// again is reached from where the machine stands.

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/letters.hpp"
#include "gateway/gcode/number.hpp"

namespace kinebus::gcode {
namespace {

constexpr std::size_t kNoObject = static_cast<std::size_t>(-1);
constexpr int kNoteForExcluded = 99996;

Pose* move_target(canonical::Command& command) {
  if (auto* move = std::get_if<canonical::Traverse>(&command)) return &move->target;
  if (auto* move = std::get_if<canonical::Feed>(&command)) return &move->target;
  if (auto* move = std::get_if<canonical::Arc>(&command)) return &move->target;
  return nullptr;
}

bool goes_aside(const Pose& from, const Pose& to) {
  for (const std::size_t axis : {kAxisX, kAxisY, kAxisA, kAxisC})
    if (std::abs(to[axis] - from[axis]) > kNoMotion) return true;
  return false;
}

}  // namespace

/// kNoObject: there are too many, or the name is too long.
std::size_t Core::object_named(std::string_view name) {
  std::vector<PrintObject>& all = state_.objects;
  const auto at =
      std::find_if(all.begin(), all.end(), [name](const PrintObject& object) { return object.name == name; });
  if (at != all.end()) return static_cast<std::size_t>(at - all.begin());
  if (all.size() == PrintObject::kMost || name.size() > PrintObject::kMaxName) return kNoObject;
  all.push_back({std::string(name), -1, false});
  return all.size() - 1;
}

std::size_t Core::object_numbered(int number) {
  std::vector<PrintObject>& all = state_.objects;
  const auto at = std::find_if(all.begin(), all.end(),
                               [number](const PrintObject& object) { return object.number == number; });
  if (at != all.end()) return static_cast<std::size_t>(at - all.begin());
  if (all.size() == PrintObject::kMost) return kNoObject;
  all.push_back({{}, number, false});
  return all.size() - 1;
}

void Core::begin_object(std::size_t object) {
  state_.modal.object = object == kNoObject ? -1 : static_cast<int>(object);
  look_whether_left_out();
}

void Core::exclude(std::size_t object, bool out) {
  state_.objects[object].excluded = out;
  if (out) {
    const PrintObject& which = state_.objects[object];
    note(kNoteForExcluded + 1'000'000 + static_cast<int>(object),
         say("the object %1 is left out", which.name.empty() ? std::to_string(which.number) : which.name));
  }
  look_whether_left_out();
}

void Core::look_whether_left_out() {
  ModalState& m = state_.modal;
  m.left_out = m.object >= 0 && state_.objects[static_cast<std::size_t>(m.object)].excluded;
  if (!m.left_out || m.away) return;
  m.away = true;
  m.real_position = m.position;
  m.real_frame = m.frame;
  m.real_e_max_mm = m.e_max_mm;
}

bool Core::object_command(const ObjectCommand& command) {
  const std::uint32_t column = block_.command_column;
  const std::string_view word = command.word;
  if (word == "exclude_object_end") {
    begin_object(kNoObject);
    return true;
  }
  if (command.reset) {
    for (PrintObject& object : state_.objects) object.excluded = false;
    look_whether_left_out();
    if (command.name.empty()) return true;
  }
  if (word == "exclude_object" && command.name.empty()) {
    if (!command.current) return true;  // asks for the list
    if (state_.modal.object < 0) return fail(column, say("no object of the print is at work here"));
    exclude(static_cast<std::size_t>(state_.modal.object), true);
    return true;
  }
  if (command.name.empty()) {
    if (word == "exclude_object_define") return true;
    return fail(column, say("%1 needs %2", std::string(block_.command), "NAME="));
  }
  const std::size_t object = object_named(command.name);
  if (object == kNoObject)
    return fail(column, say("too many objects, or too long a name (1000 of 200 letters at most)"));
  if (word != "exclude_object") state_.modal.objects_by_code = true;
  if (word == "exclude_object_start") begin_object(object);
  if (word == "exclude_object") exclude(object, true);
  return true;
}

/// Between two lines of the text.
bool Core::exclude_object(std::string_view name) {
  if (state_.modal.cutter != CutterSide::kOff)
    return fail(0, say("no object can be left out while cutter compensation is on"));
  const std::string small = in_lower_case(name);
  const auto known =
      std::find_if(state_.objects.begin(), state_.objects.end(), [&](const PrintObject& object) {
        return object.name.empty() ? std::to_string(object.number) == small : object.name == small;
      });
  const std::size_t object = known != state_.objects.end()
                                 ? static_cast<std::size_t>(known - state_.objects.begin())
                                 : object_named(small);
  if (object == kNoObject)
    return fail(0, say("too many objects, or too long a name (1000 of 200 letters at most)"));
  exclude(object, true);
  return true;
}

/// M486: T how many, S begins (-1: ends), A"name", P leaves out, U takes back, C leaves out the one at work.
bool Core::object_code(Code code) {
  if (block_.m_count > 1 || block_.groups != 0 || block_.present != 0)
    return fail(code.column, say("%1 stands alone in its line", "M486"));
  const std::string_view text = block_.text;
  const std::vector<PrintObject> before = state_.objects;
  const auto wrong = [&](Sentence words) {
    state_.objects = before;
    return fail(block_.text_column, std::move(words));
  };
  for (std::size_t at = 0; at < text.size();) {
    const char letter = in_lower_case(text[at++]);
    if (letter == ' ' || letter == '\t') continue;
    if (letter == '(') break;
    if (letter == 'a') {
      const std::size_t open = text.find('"', at);
      const std::size_t close = open == std::string_view::npos ? open : text.find('"', open + 1);
      if (close == std::string_view::npos) return wrong(say("M486 A needs a name in quotation marks"));
      const std::string name = in_lower_case(text.substr(open + 1, close - open - 1));
      if (name.size() > PrintObject::kMaxName)
        return wrong(say("too many objects, or too long a name (1000 of 200 letters at most)"));
      at = close + 1;
      if (state_.modal.object < 0) continue;
      // What was left out by name before it had a number stays so.
      PrintObject& object = state_.objects[static_cast<std::size_t>(state_.modal.object)];
      for (const PrintObject& other : state_.objects)
        if (other.name == name) object.excluded |= other.excluded;
      object.name = name;
      look_whether_left_out();
      continue;
    }
    if (letter == 'c') {
      if (state_.modal.object < 0) return wrong(say("no object of the print is at work here"));
      exclude(static_cast<std::size_t>(state_.modal.object), true);
      continue;
    }
    double value = 0;
    const char* const after = parse_decimal(text.data() + at, text.data() + text.size(), value);
    const bool known = letter == 's' || letter == 'p' || letter == 'u' || letter == 't';
    if (!known || after == nullptr || value != std::floor(value) || value < -1 || value > 1e6)
      return wrong(say("M486 takes S, P, U, T with a whole number, C and A\"name\""));
    at = static_cast<std::size_t>(after - text.data());
    if (letter == 't') continue;
    const std::size_t object = value < 0 ? kNoObject : object_numbered(static_cast<int>(value));
    if (object == kNoObject && value >= 0)
      return wrong(say("too many objects, or too long a name (1000 of 200 letters at most)"));
    state_.modal.objects_by_code |= letter == 's';
    if (letter == 's') begin_object(object);
    if (letter != 's' && object != kNoObject) exclude(object, letter == 'p');
  }
  return true;
}

/// What PrusaSlicer and its heirs write about a move's object when they write no commands.
bool Core::read_object_comment(std::string_view comment) {
  constexpr std::string_view kBegin = "; printing object ", kEnd = "; stop printing object ";
  const bool begins = comment.starts_with(kBegin);
  if ((!begins && !comment.starts_with(kEnd)) || state_.modal.objects_by_code) return false;
  std::string name = begins ? in_lower_case(comment.substr(kBegin.size())) : std::string();
  while (!name.empty() && (name.back() == ' ' || name.back() == '\r')) name.pop_back();
  begin_object(begins ? object_named(name) : kNoObject);
  return true;
}

/// Takes the moves out of what a line gave out, from out_[from] on, or brings the machine to where the text
/// goes on. `before`: the line.
bool Core::leave_out(std::size_t from, const ModalState& before) {
  ModalState& m = state_.modal;
  if (out_->size() == from) return true;
  CommandBuffer given(out_->begin() + static_cast<std::ptrdiff_t>(from), out_->end());
  out_->resize(from);
  Pose at = before.position;  // where the text has the tool
  double shift_e = 0;
  for (canonical::Line& line : given) {
    if (auto* set = std::get_if<canonical::SetPosition>(&line.command); set != nullptr && m.away) {
      if (set->frame != m.real_frame)
        return fail(1, say("G43.4 and tilted planes cannot begin or end while an object is left out"));
      set->pose = m.real_position;
    }
    if (auto* home = std::get_if<canonical::Home>(&line.command); home != nullptr && m.away) {
      for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis)
        if (home->axes != 0 && (home->axes >> axis & 1U) == 0) home->afterwards[axis] = m.real_position[axis];
      at = home->afterwards;
      at[kAxisE] = m.position[kAxisE];
      home->afterwards[kAxisE] = before.real_position[kAxisE];
      m.position = m.real_position = at;
      m.real_position[kAxisE] = before.real_position[kAxisE];
      refresh();
    }
    Pose* const target = move_target(line.command);
    if (target == nullptr) {
      const bool waits = std::holds_alternative<canonical::Dwell>(line.command);
      if (!waits || !m.left_out) out_->push_back(std::move(line));
      continue;
    }
    if (m.left_out) {
      at = *target;
      continue;
    }
    if (m.away) {
      const bool is_arc = std::holds_alternative<canonical::Arc>(line.command);
      const bool extrudes =
          (*target)[kAxisE] > (goes_aside(at, *target) ? at[kAxisE] : before.e_max_mm) + kNoMotion;
      if (!is_arc && !extrudes && !goes_aside(at, *target)) {
        // A lift or a retraction where the machine is not: the way back contains it.
        at = *target;
        continue;
      }
      shift_e = m.real_e_max_mm - before.e_max_mm;
      const bool from_there = is_arc || extrudes;
      come_back(from_there ? at : *target, shift_e, line.line);
      m.e_canonical_base_mm += shift_e;
      m.position[kAxisE] += shift_e;
      m.e_max_mm += shift_e;
      if (!from_there) {
        at = *target;
        continue;
      }
    }
    at = *target;
    (*target)[kAxisE] += shift_e;
    out_->push_back(std::move(line));
  }
  return true;
}

/// From where the machine stands to `goal`, whose E is the text's: over the higher of the two, with as much
/// filament taken back as the text has taken back there.
void Core::come_back(const Pose& goal, double shift_e, std::uint32_t line) {
  ModalState& m = state_.modal;
  m.away = false;
  Pose pose = m.real_position;
  const double e = goal[kAxisE] + shift_e;
  const auto feed_e = [&] {
    if (std::abs(e - pose[kAxisE]) <= kNoMotion) return;
    pose[kAxisE] = e;
    out_->push_back({line, canonical::Feed{pose, m.frame, m.retract_mm_per_s, 0}});
  };
  const auto go = [&](const Pose& to) {
    Pose next = to;
    next[kAxisE] = pose[kAxisE];
    if (next == pose) return;
    pose = next;
    out_->push_back({line, canonical::Traverse{pose, m.frame, 0}});
  };
  if (e < pose[kAxisE]) feed_e();
  const double high = std::max(pose[kAxisZ], goal[kAxisZ]);
  Pose lifted = pose, over = goal;
  lifted[kAxisZ] = over[kAxisZ] = high;
  go(lifted);
  go(over);
  go(goal);
  feed_e();
}

}  // namespace kinebus::gcode
