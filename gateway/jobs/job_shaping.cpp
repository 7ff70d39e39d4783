#include "gateway/jobs/job_shaping.hpp"

namespace kinebus {

Result<VibrationDescription, Sentence> shaped_by_job(const Kinematics& kinematics,
                                                     const VibrationDescription& before,
                                                     const canonical::InputShaping& asked) {
  VibrationDescription after = before;
  after.every = {};
  std::optional<AxisVibration>* const axes[] = {&after.x, &after.y, &after.z};
  for (std::size_t i = 0; i < asked.axes.size(); ++i) {
    const canonical::InputShaping::Axis& a = asked.axes[i];
    AxisVibration axis = before.axis(i);
    if (a.damping_ratio >= 0) axis.damping_ratio = a.damping_ratio;
    if (a.frequency_hz > 0) axis.frequency_hz = a.frequency_hz;
    if (a.shaper)
      axis.shaper = *a.shaper;
    else if (a.frequency_hz > 0 && axis.shaper == ShaperKind::kNone)
      axis.shaper = a.usual;
    if (a.frequency_hz == 0) axis.shaper = ShaperKind::kNone;
    if (axis.shaper != ShaperKind::kNone && !(axis.frequency_hz > 0))
      return Error<Sentence>(
          say("a shaper without a frequency: neither the job nor [vibration] has said one"));
    *axes[i] = axis;
  }
  const bool z_asks = asked.axes[2].asks();
  if (turns_part(kinematics)) {
    if (!z_asks) after.z = after.x;
    if (!(after.axis(0) == after.axis(1) && after.axis(1) == after.axis(2)))
      return Error<Sentence>(
          say("different shapers on a machine that turns or tilts the part: one shaper for X, Y and Z is "
              "needed"));
  }
  return after;
}

void merge_shaping(canonical::InputShaping& all, const canonical::InputShaping& more) {
  for (std::size_t i = 0; i < all.axes.size(); ++i) {
    canonical::InputShaping::Axis& axis = all.axes[i];
    const canonical::InputShaping::Axis& next = more.axes[i];
    if (next.shaper) axis.shaper = next.shaper;
    if (next.frequency_hz >= 0) axis.frequency_hz = next.frequency_hz;
    if (next.damping_ratio >= 0) axis.damping_ratio = next.damping_ratio;
    if (next.asks()) axis.usual = next.usual;
  }
}

}  // namespace kinebus
