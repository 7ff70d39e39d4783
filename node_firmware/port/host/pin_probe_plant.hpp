#pragma once
// A BLTouch by its data sheet, with what can break of it: a pin that falls out, is pushed in by the bed or
// drawn in, and a line. Modes are taken from pulses that came several times. No clock of its own.

#include <cstdint>
#include <cstdlib>

namespace kinebus::heat {

class PinProbePlant {
 public:
  static constexpr double kPin = 5.2;  // mm, from in to out

  // What can break, at any time.
  bool stays_in = false, hangs_out = false;
  bool falls_out = false;  ///< its magnet holds nothing: out, unless the bed pushes it in

  /// One sample's time, 10 ms, under pulses of that width.
  void step(std::uint16_t pulse_us) {
    same_ = pulse_us == pulse_ ? same_ + 1 : 0;
    pulse_ = pulse_us;
    if (pulse_us != 0 && same_ == kTaken) take(pulse_us);
    if (moving_ > 0 && --moving_ == 0) arrive();
    if (high_ > 0) --high_;
  }
  /// How far the tip of the pin, when it is out, is clear of what is below it, mm.
  void meet(double gap_mm) {
    gap_mm_ = gap_mm;
    if (out_ && gap_mm <= 0) touch();
    if (falls_out && gap_mm > 0) out_ = true;
  }
  /// Its own alarm: it blinks, the line is high, and only a reset ends it; unless it comes back.
  void alarm(bool lasting) {
    lasting_alarm_ = lasting;
    alarm_ = true;
  }
  void mend() { stays_in = hangs_out = falls_out = lasting_alarm_ = false; }

  bool out() const { return out_; }
  bool alarmed() const { return alarm_; }
  bool line() const { return alarm_ || (touch_mode_ ? !out_ : high_ > 0); }
  unsigned deployed() const { return deployed_; }

 private:
  static constexpr int kTaken = 6, kWay = 33, kPulse = 2;  // samples
  void take(std::uint16_t us) {
    const auto is = [us](int width) { return std::abs(us - width) <= 25; };
    if (is(2194)) {
      alarm_ = lasting_alarm_;
      touch_mode_ = false;
      wanted_ = false;
      moving_ = kWay;
    }
    if (alarm_) return;
    if (is(1162)) touch_mode_ = true;
    if (is(647) || is(1472)) {
      touch_mode_ = false;
      wanted_ = is(647);
      moving_ = kWay;
    }
  }
  void arrive() {
    if (wanted_ == out_) return;
    if (!wanted_) {
      out_ = hangs_out || (falls_out && gap_mm_ > 0);
      return;
    }
    // It feels that its pin has not come down.
    if (stays_in || gap_mm_ <= 0) {
      alarm_ = true;
      return;
    }
    out_ = true;
    ++deployed_;
  }
  void touch() {
    high_ = kPulse;
    if (!hangs_out) out_ = false;
  }

  bool out_ = false, wanted_ = false, touch_mode_ = false, alarm_ = false, lasting_alarm_ = false;
  int same_ = 0, moving_ = 0, high_ = 0;
  std::uint16_t pulse_ = 0;
  unsigned deployed_ = 0;
  double gap_mm_ = 1e3;
};

}  // namespace kinebus::heat
