#pragma once
// What an accelerometer of the tool feels, as energy over frequency: decimated to 400 Hz, in windows of 2.56
// s that overlap by three quarters, transformed and summed on the node. A raw recording of a minute would
// take a third of the bus; this takes some kilobytes, whenever the master likes.
//
// The windows are Hann's: at this overlap their squares add up to the same everywhere, so that it does not
// matter when a frequency comes by. Decimation is by a triangle of 15 readings, whose gain is known:
// decimation_gain().

#include <array>
#include <cstdint>
#include <span>

#include "node_firmware/heat/fixed_fft.hpp"
#include "node_firmware/heat/vibration_unit.hpp"
#include "protocol/canopen/heat_units.hpp"
#include "protocol/time.hpp"

namespace kinebus::heat {

/// The values are those of 2270h.
enum class VibrationState : std::uint8_t { kNone, kReady, kMeasures, kSilent };

class VibrationMeter final : public VibrationUnit {
 public:
  using Reading = std::array<std::int16_t, 3>;  ///< X Y Z of the chip, in its counts
  static constexpr int kDecimation = 8;
  static constexpr int kPoints = FixedFft::kPoints, kHop = kPoints / 4;
  /// A chip that is asked and says nothing for so long is out of order.
  static constexpr LocalTime kPatience = std::chrono::milliseconds{500};

  /// `um_per_s2`: of a count. `range`: the last count before it clips.
  VibrationMeter(std::uint32_t um_per_s2, std::int16_t range) : um_per_s2_(um_per_s2), range_(range) {}

  /// Everything that the chip has measured since the last call, in its order. Called every 5 ms (an ADXL345
  /// keeps 32 readings, which is hardly 10 ms), with nothing, too. Does its share of the transform's work.
  void on_readings(LocalTime now, std::span<const Reading> readings);

  void begin(LocalTime now);
  /// What was found stays to be read.
  void end();
  VibrationState state() const { return state_; }
  std::uint16_t windows() const { return windows_; }
  std::uint16_t clipped() const { return clipped_; }
  /// Readings of the chip, thousandths of one a second, by the node's clock; 0: not known yet.
  std::uint32_t rate_mhz() const;
  /// Of an axis in a band: sum over all windows, in 2^exponent(axis).
  std::uint32_t energy(int axis, int band) const {
    return energy_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(band)];
  }
  int exponent(int axis) const { return exponent_[static_cast<std::size_t>(axis)]; }

  AbortCode read(ObjectAddress address, std::int64_t& value) const override;
  AbortCode write(ObjectAddress address, std::int64_t value) override;

 private:
  enum class Work : std::uint8_t { kNothing, kFirstTwo, kThird };
  void take(const Reading& reading);
  void take_decimated();
  void do_work();
  void fill(int re_axis, int im_axis);
  std::int32_t mean(int axis) const;
  void add(int axis, int band, std::uint64_t energy);

  std::uint32_t um_per_s2_;
  std::int16_t range_;
  VibrationState state_ = VibrationState::kReady;
  LocalTime now_{0}, began_{0}, heard_{0};
  LocalTime counted_{0};  ///< when readings_ were counted last
  std::uint32_t readings_ = 0;
  std::uint16_t windows_ = 0, clipped_ = 0, band_ = 0;
  Reading last_{};

  int in_block_ = 0;
  std::array<std::int32_t, 3> rising_{}, falling_{}, before_{};
  bool first_block_ = true;
  std::array<std::array<std::int16_t, kPoints>, 3> ring_{};
  int at_ = 0, filled_ = 0, fresh_ = 0;

  Work work_ = Work::kNothing;
  int summed_ = 0;  ///< bands of the transform that is done
  FixedFft fft_;
  std::array<std::array<std::uint32_t, kVibrationBands>, 3> energy_{};
  std::array<std::int8_t, 3> exponent_{};
};

}  // namespace kinebus::heat
