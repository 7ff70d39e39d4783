// G38.2 to G38.5.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/words/rotation.hpp"

namespace kinebus::gcode {
namespace {

constexpr std::size_t kProbedFirst = 5061, kProbed = 5070;
// X Y Z A B C among them.
constexpr std::array<int, 6> kProbedAxes = {kAxisX, kAxisY, kAxisZ, kAxisA, -1, kAxisC};
constexpr int kNoteForProbeSpeed = 138200;

}  // namespace

bool Core::probe(Code code) {
  ModalState& m = state_.modal;
  const std::string name = g_name(code.number);
  if (options_.probe == ProbeFitted::kNone)
    return fail(code.column, say("%1 needs a probe: the machine file has no [probe]", name));
  if (options_.probe == ProbeFitted::kSimulated)
    return fail(code.column,
                say("%1 needs a probe that can touch: the machine file's has where = \"simulated\"; one on a "
                    "node probes, on a virtual one, too",
                    name));
  if (m.inverse_time) return fail(code.column, say("%1 needs a feed for each minute: G94", name));
  if (m.tilted)
    return fail(code.column, say("%1 cannot be used in a tilted plane: end it with G69 first", name));
  if (m.left_out || m.away)
    return fail(code.column, say("%1 cannot be used while an object is left out", name));
  Pose program = m.program, target = m.position;
  if (!probe_target(code, program, target)) return false;
  FeedRate feed{m.feed_known, m.feed_mm_per_s, m.feed_rad_per_s};
  if (has('F') && !feed_from(block_['F'], feed)) return false;
  used_ |= block_.present & (Block::bit('X') | Block::bit('Y') | Block::bit('Z') | Block::bit('F'));
  if (!check_leftovers()) return false;
  const double wanted = feed.known ? feed.mm_per_s * m.feed_ratio : options_.probe_mm_per_s;
  const double speed = std::min(wanted, options_.probe_mm_per_s);
  if (speed < wanted)
    note(kNoteForProbeSpeed, say("probing goes at %1 mm/s: faster is not allowed by probe.speed_mm_per_s",
                                 printed("%.6g", speed)));
  probe_goes_on_ = false;
  emit(canonical::Probe{target, m.frame, speed, code.number >= 384, code.number % 2 == 0});
  m.position = target;
  m.program = program;
  m.feed_known = feed.known;
  m.feed_mm_per_s = feed.mm_per_s;
  m.feed_rad_per_s = feed.rad_per_s;
  tell_probed(program, true);
  return true;
}

bool Core::probe_target(Code code, Pose& program, Pose& target) {
  const ModalState& m = state_.modal;
  const std::string name = g_name(code.number);
  if (block_.has(GGroup::kNonmodal) && block_.code(GGroup::kNonmodal).number == 530)
    return fail(block_.code(GGroup::kNonmodal).column, say("G53 needs G0 or G1, in this line or active"));
  for (const char letter : {'A', 'C', 'E'})
    if (has(letter)) return fail(block_.column_of(letter), say("%1 moves X, Y and Z alone", name));
  const bool aside = std::any_of(options_.probe_offset_mm.begin(), options_.probe_offset_mm.end(),
                                 [](double mm) { return mm != 0; });
  const bool turned = std::abs(m.position[kAxisA]) > kNoMotion || std::abs(m.position[kAxisC]) > kNoMotion;
  if (aside && turned)
    return fail(code.column,
                say("%1 with a probe beside the tool (probe.offset_mm) needs A and C at 0", name));
  double farthest = 0;
  program_target(program);
  for (const Axis axis : {kAxisX, kAxisY, kAxisZ}) {
    const char letter = kAxisLetters[axis];
    if (!has(letter)) continue;
    if (block_.is_bare(letter)) return fail(block_.column_of(letter), say("%1 needs a number", letter));
    target[axis] = program[axis] + shift_[axis];
  }
  if (is_turned()) set_xyz(target, to_canonical_xyz(xyz(program)));
  for (const Axis axis : {kAxisX, kAxisY, kAxisZ})
    farthest = std::max(farthest, std::abs(target[axis] - m.position[axis]));
  if (farthest > kNoMotion) return true;
  return fail(code.column, say("%1 needs X, Y or Z of a place that is not where the tool stands", name));
}

/// `program`: the point, mm and rad.
void Core::tell_probed(const Pose& program, bool contact) {
  auto& numbered = state_.parameters.numbered;
  std::fill(&numbered[kProbedFirst], &numbered[kProbed], 0.0);
  for (std::size_t slot = 0; slot < kProbedAxes.size(); ++slot) {
    if (kProbedAxes[slot] < 0) continue;
    const auto axis = static_cast<std::size_t>(kProbedAxes[slot]);
    const bool turns = axis == kAxisA || axis == kAxisC;
    const double offset = axis <= kAxisZ ? options_.probe_offset_mm[axis] : 0;
    const double unit = turns ? std::numbers::pi / 180 : state_.modal.inches ? 25.4 : 1;
    numbered[kProbedFirst + slot] = (program[axis] + offset) / unit;
  }
  numbered[kProbed] = contact ? 1 : 0;
}

void Core::set_probed(const ProbeResult& result) {
  if (probe_goes_on_) return probe_within(result);
  ModalState& m = state_.modal;
  const double e = m.position[kAxisE];
  m.position = in_frame(result.at, result.frame, m.frame);
  m.position[kAxisE] = e;
  refresh();
  tell_probed(m.program, result.contact);
  set_position(result.stand, result.frame);
}

}  // namespace kinebus::gcode
