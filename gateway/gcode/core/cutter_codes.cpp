// Cutter compensation: G40, G41, G42, G41.1, G42.1, and what cannot stand beside it.

#include <cmath>
#include <utility>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/words/parameters.hpp"

namespace kinebus::gcode {
namespace {

// How far the tool may lean from the plane's normal: rounding of angles that G53.1 chose.
constexpr double kUpright = 1e-6;

/// Where a lathe's tip is from the middle of its round, along Z and X, radii: LinuxCNC's tool orientations.
constexpr std::array<Point2, 10> kTips{
    {{0, 0}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}, {1, 0}, {0, -1}, {-1, 0}, {0, 1}, {0, 0}}};

}  // namespace

bool Core::refuse_beside_cutter(Code code, const std::string& name) {
  const std::uint32_t column = code.column != 0 ? code.column : 1;
  return fail(column,
              state_.modal.cutter == CutterSide::kBeside
                  ? say("after G40 a straight move (G0, G1) comes first: %1 cannot stand here", name)
                  : say("%1 cannot stand while cutter compensation is on: end it with G40 first", name));
}

/// What the line says of it, or the table.
bool Core::cutter_tool(Code code, double& diameter, int& orientation) {
  const ModalState& m = state_.modal;
  if (code.number == 411 || code.number == 421) {
    if (!has('D')) return fail(code.column, say("%1 needs D, the tool's diameter", g_name(code.number)));
    if (!take('D', diameter) || !take_integer('L', 0, 9, orientation)) return false;
    diameter = length(diameter);
    return true;
  }
  int tool = m.tool_in_spindle >= 0 ? m.tool_in_spindle : m.tool;
  const bool given = has('D');
  if (!take_integer('D', 0, 99'999, tool)) return false;
  const ToolEntry entry = tool_entry(tool);
  diameter = entry.diameter_mm;
  orientation = entry.orientation;
  return diameter != 0 || (given && tool == 0) ||
         fail(code.column,
              say("the diameter of T%1 is not known: write gcode.tool_diameter_mm in the machine file, "
                  "or G41.1 D with the diameter",
                  tool));
}

bool Core::cutter_on(Code code) {
  ModalState& m = state_.modal;
  if (m.cutter != CutterSide::kOff) return refuse_beside_cutter(code, g_name(code.number));
  double diameter = 0;
  int orientation = 0;
  if (!cutter_tool(code, diameter, orientation)) return false;
  const Point2 tip = kTips[static_cast<std::size_t>(orientation)] * (std::abs(diameter) / 2);
  if (m.plane != Plane::kZx && length_of(tip) > 0)
    return fail(
        block_.has('L') ? block_.column_of('L') : code.column,
        say("the tip of a lathe's tool (orientation %1) counts in the plane of G18 alone", orientation));
  const PlaneAxes plane = plane_axes();
  std::array<Vector3, 3> axes{};
  std::size_t at = 0;
  const Matrix3 directions = program_axes();
  for (const std::size_t axis : {plane.u, plane.v, plane.w}) {
    for (std::size_t i = 0; i < 3; ++i) axes[at][i] = directions[i][axis];
    ++at;
  }
  if (m.frame == Frame::kPart) {
    const Vector3 up = rotation_x(m.position[kAxisA]) * (rotation_z(m.position[kAxisC]) * axes[2]);
    if (std::hypot(up[0], up[1]) > kUpright || up[2] < 0)
      return fail(code.column,
                  say("the tool does not stand upright on the plane of %1: turn it with G53.1 first",
                      g_name(code.number)));
  }
  if (!compensate()) return false;
  // A negative diameter is the other side, as LinuxCNC has it.
  m.cutter = (code.number < 420) == (diameter >= 0) ? CutterSide::kLeft : CutterSide::kRight;
  state_.cutter.begin(m.cutter, std::abs(diameter) / 2, axes[0], axes[1], axes[2], m.position, m.frame, tip);
  return true;
}

bool Core::cutter_off() {
  ModalState& m = state_.modal;
  if (!cutter_is_on()) return true;
  if (!compensate()) return false;
  Sentence words;
  if (!state_.cutter.end(*out_, words)) return fail(1, std::move(words));
  uncompensated_ = out_->size();
  const bool beside = norm(xyz(state_.cutter.tool()) - xyz(m.position)) > kNoMotion;
  m.cutter = beside ? CutterSide::kBeside : CutterSide::kOff;
  return true;
}

/// The tool is where it is: that is the current point.
void Core::end_beside() {
  ModalState& m = state_.modal;
  const double e = m.position[kAxisE];
  m.position = state_.cutter.tool();
  m.position[kAxisE] = e;
  m.cutter = CutterSide::kOff;
  refresh();
}

/// The codes of the line that would move or turn the plane, or change the tool.
bool Core::check_beside_cutter() {
  const ModalState& m = state_.modal;
  const auto refuse = [this](Code code) { return refuse_beside_cutter(code, g_name(code.number)); };
  const bool on = cutter_is_on();
  if (block_.has(GGroup::kTilt) && (m.tilted || block_.code(GGroup::kTilt).number != 690))
    return refuse(block_.code(GGroup::kTilt));
  if (block_.has(GGroup::kToolLength) &&
      (on || m.tool_centre_point || block_.code(GGroup::kToolLength).number == 434))
    return refuse(block_.code(GGroup::kToolLength));
  if (block_.has(GGroup::kNonmodal)) {
    const Code code = block_.code(GGroup::kNonmodal);
    const bool offsets = (code.number == 100 && block_.has('L')) ||
                         (code.number >= 280 && code.number < 290) || code.number == 300 ||
                         code.number == 301 || code.number == 520 || code.number == 530 ||
                         (code.number >= 920 && code.number <= 923);
    if (code.number == 531 || (on && offsets)) return refuse(code);
  }
  if (!on) return true;
  if (block_.has(GGroup::kPlane)) {
    const Code code = block_.code(GGroup::kPlane);
    const Plane plane = code.number == 170 ? Plane::kXy : code.number == 180 ? Plane::kZx : Plane::kYz;
    if (plane != m.plane) return refuse(code);
  }
  if (block_.has(GGroup::kCoordinates)) return refuse(block_.code(GGroup::kCoordinates));
  if (block_.has_m(6)) return refuse_beside_cutter({0, 1}, "M6");
  if (block_.has_m(66)) return refuse_beside_cutter({0, 1}, "M66");
  // On a mill T only says what M6 will put in.
  if (block_.has('T') && !options_.spindle) return refuse_beside_cutter({0, block_.column_of('T')}, "T");
  return true;
}

bool Core::compensate() {
  ModalState& m = state_.modal;
  if (m.cutter == CutterSide::kOff) [[likely]] {
    uncompensated_ = out_->size();
    return true;
  }
  if (m.away || m.left_out) return refuse_beside_cutter({0, 1}, "EXCLUDE_OBJECT");
  const auto first = out_->begin() + static_cast<std::ptrdiff_t>(uncompensated_);
  CommandBuffer given(std::make_move_iterator(first), std::make_move_iterator(out_->end()));
  out_->resize(uncompensated_);
  for (canonical::Line& line : given) {
    if (std::holds_alternative<canonical::End>(line.command)) {
      Sentence words;
      if (cutter_is_on() && !state_.cutter.end(*out_, words)) return fail(1, std::move(words));
      end_beside();
    }
    if (cutter_is_on()) {
      Sentence words;
      if (!state_.cutter.take(std::move(line), *out_, words)) return fail(1, std::move(words));
      continue;
    }
    if (m.cutter == CutterSide::kBeside) {
      if (std::holds_alternative<canonical::Arc>(line.command)) {
        const Code code = block_.has(GGroup::kMotion) ? block_.code(GGroup::kMotion) : Code{0, 1};
        return refuse_beside_cutter(code, m.motion == Motion::kArcClockwise ? "G2" : "G3");
      }
      if (auto* set = std::get_if<canonical::SetPosition>(&line.command)) set->pose = state_.cutter.tool();
      if (std::holds_alternative<canonical::Traverse>(line.command) ||
          std::holds_alternative<canonical::Feed>(line.command) ||
          std::holds_alternative<canonical::Home>(line.command))
        m.cutter = CutterSide::kOff;
    }
    out_->push_back(std::move(line));
  }
  uncompensated_ = out_->size();
  return true;
}

}  // namespace kinebus::gcode
