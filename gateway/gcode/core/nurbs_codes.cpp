// G5.2 with G5.3, and G6.2: a NURBS, a control point a line.
//
// G5.2 is LinuxCNC's: P weights, L the order, the first point is where the tool stands, even knots. G6.2 is
// that of Fanuc's control: P the order, K knots, R weights; after the points come as many lines with K alone
// as the order is, and the last of them ends it.

#include <algorithm>
#include <cmath>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {
namespace {

constexpr int kBegins = 52, kEnds = 53;  // G5.2, G5.3
constexpr std::size_t kMostPieces = 200'000;
constexpr double kLeastWeight = 1e-6, kMostWeight = 1e6;

}  // namespace

bool Core::check_beside_nurbs() {
  constexpr std::uint32_t kMotionBit = 1U << static_cast<unsigned>(GGroup::kMotion);
  const int open = state_.modal.nurbs;
  const bool motion = block_.has(GGroup::kMotion);
  const int number = motion ? block_.code(GGroup::kMotion).number : open;
  const bool goes_on = number == open || (number == kEnds && open == kBegins);
  if (goes_on && (block_.groups & ~kMotionBit) == 0 && block_.m_count == 0 && block_.command.empty() &&
      !block_.percent)
    return true;
  return fail(motion ? block_.code(GGroup::kMotion).column : 1,
              open == kBegins ? say("the NURBS that G5.2 began has no end: write G5.3 before this line")
                              : say("the NURBS that G6.2 began has no end: as many lines with K alone as its "
                                    "order P come behind its points"));
}

bool Core::begin_nurbs(Code code) {
  ModalState& m = state_.modal;
  const std::string name = g_name(code.number);
  if (code.number == kEnds) return fail(code.column, say("%1 ends a NURBS, and none has begun", name));
  if (m.cutter != CutterSide::kOff) return refuse_beside_cutter(code, name);
  if (m.inverse_time) return fail(code.column, say("%1 needs feed per minute (G94)", name));
  if (!m.feed_known) return fail(code.column, say("no feed rate is set: this move needs F"));
  if (block_.has(GGroup::kNonmodal)) return fail(code.column, say("%1 stands in a line of its own", name));
  m.cycle = 0;
  m.motion = Motion::kNone;
  m.nurbs = code.number;
  m.nurbs_start = m.program;
  state_.nurbs = {};
  if (code.number == kBegins) add_nurbs_point(1);
  return true;
}

void Core::add_nurbs_point(double weight) {
  const Pose& p = state_.modal.program;
  state_.nurbs.points.push_back({p[kAxisX], p[kAxisY], p[kAxisZ], p[kAxisE]});
  state_.nurbs.weights.push_back(weight);
}

bool Core::nurbs_order(char letter) {
  int order = static_cast<int>(state_.nurbs.order);
  // Two points make a line: LinuxCNC takes 3 for what is less, and Fanuc 2 for a polygon.
  if (!take_integer(letter, letter == 'L' ? 3 : 2, static_cast<int>(Nurbs::kMostOrder), order)) return false;
  state_.nurbs.order = static_cast<std::size_t>(order);
  return true;
}

bool Core::run_nurbs() {
  ModalState& m = state_.modal;
  Nurbs& curve = state_.nurbs;
  const bool named = block_.has(GGroup::kMotion);
  const Code code = named ? block_.code(GGroup::kMotion) : Code{m.nurbs, 1};
  const std::string name = g_name(code.number);
  if (code.number == kEnds && m.nurbs == kBegins) {
    if (curve.points.size() < curve.order)
      return fail(code.column, say("a NURBS of order %1 needs as many points, and has %2",
                                   static_cast<int>(curve.order), static_cast<int>(curve.points.size())));
    curve.set_even_knots();
    return end_nurbs(code);
  }
  const bool begins = m.nurbs == 0;
  if (begins && !begin_nurbs(code)) return false;
  const std::uint32_t words = block_.present & ~used_;
  if (words == 0 && !named) return true;
  constexpr std::string_view kCoordinates = "XYZE";
  bool point = false;
  for (const char letter : kCoordinates) {
    if (!has(letter)) continue;
    if (block_.is_bare(letter)) return fail(block_.column_of(letter), say("%1 needs a number", letter));
    point = true;
  }
  for (const char letter : {'A', 'C'})
    if (has(letter)) return fail(block_.column_of(letter), say("%1 has no place in a spline", letter));
  if (point && curve.points.size() >= Nurbs::kMostPoints)
    return fail(code.column,
                say("a NURBS has %1 control points at most", static_cast<int>(Nurbs::kMostPoints)));

  const bool fanuc = m.nurbs != kBegins;
  double weight = 1;
  const char weight_letter = fanuc ? 'R' : 'P';
  if (fanuc && begins && !has('P')) return fail(code.column, say("%1 needs its order P", name));
  if (!nurbs_order(fanuc ? 'P' : 'L')) return false;
  const bool weighted = has(weight_letter);
  const std::uint32_t weight_column = block_.column_of(weight_letter);
  if (!take_if_given(weight_letter, weight)) return false;
  if (weighted && !(weight >= kLeastWeight && weight <= kMostWeight))
    return fail(weight_column, say("the weight %1 of a control point is 0.000001 to 1000000", weight_letter));
  if (fanuc) {
    pass_over('Q');
    double knot = 0;
    if (!has('K')) return fail(code.column, say("each line of G6.2 needs its knot K"));
    const std::uint32_t column = block_.column_of('K');
    if (!take('K', knot)) return false;
    if (!curve.knots.empty() && !(knot >= curve.knots.back()))
      return fail(column, say("the knots K of a NURBS cannot fall"));
    if (point && curve.knots.size() > curve.points.size())
      return fail(code.column, say("a line with K alone came before: no more points can follow"));
    if (curve.knots.size() >= Nurbs::kMostPoints + Nurbs::kMostOrder)
      return fail(code.column,
                  say("a NURBS has %1 control points at most", static_cast<int>(Nurbs::kMostPoints)));
    curve.knots.push_back(knot);
  } else if (!point && weighted) {
    if (curve.points.size() != 1)
      return fail(weight_column, say("P without X Y Z is the weight of the first control point"));
    curve.weights.front() = weight;
  }
  if (!point) return !fanuc || curve.knots.size() < curve.points.size() + curve.order || end_nurbs(code);

  Pose to = m.program;
  program_target(to);
  for (const char letter : kCoordinates) pass_over(letter);
  m.program = to;
  add_nurbs_point(weight);
  if (fanuc && curve.points.size() == 1) {
    double off = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) off = std::hypot(off, to[axis] - m.nurbs_start[axis]);
    if (off > options_.arc_radius_tolerance_mm)
      return fail(code.column, say("the first control point of G6.2 must be where the tool stands"));
  }
  return true;
}

bool Core::end_nurbs(Code code) {
  ModalState& m = state_.modal;
  if (!state_.nurbs.is_clamped())
    return fail(code.column,
                say("the knots K have to begin and end with as many equal ones as the order P, and "
                    "to have fewer equal ones between"));
  std::vector<Nurbs::Point> ends;
  if (!flatten(state_.nurbs, kSplineFlatness_mm, kMostPieces, ends))
    return fail(code.column, say("the spline is too large"));
  Pose program = m.nurbs_start;
  for (const Nurbs::Point& end : ends) {
    for (std::size_t k = 0; k < 3; ++k) program[k] = end[k];
    program[kAxisE] = end[3];
    const Pose target = canonical_pose(program);
    emit(canonical::Feed{target, m.frame, m.feed_mm_per_s * m.feed_ratio, 0});
    m.position = target;
    m.e_max_mm = std::max(m.e_max_mm, target[kAxisE]);
  }
  m.nurbs = 0;
  return true;
}

}  // namespace kinebus::gcode
