#pragma once
// One heater measured by its node, seen from the gateway: 2224h begins it, 2225h tells how far it is, the
// model is read (2218h to 221Bh) and kept by 1010h. Who asks the node is the link; what it asks next and what
// the answers mean is here.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "gateway/devices/device.hpp"
#include "protocol/canopen/abort_code.hpp"
#include "protocol/canopen/object.hpp"

namespace kinebus {

class HeatNodeTuning {
 public:
  struct Question {
    ObjectAddress address{};
    std::size_t bytes = 0;
    bool write = false;
    std::uint32_t value = 0;
  };
  /// Without an answer for so long the node is taken to be gone.
  static constexpr BusTime kSilence = std::chrono::seconds{5};
  /// Erasing flash memory takes the board up to 2 s.
  static constexpr BusTime kStoring = std::chrono::seconds{10};

  /// `heater`: of the node, from 0. `power_w`: its nominal power.
  void begin(BusTime now, std::size_t heater, double celsius, double power_w);
  /// Has no effect unless it runs.
  void end(Sentence why);
  bool runs() const { return told_.runs(); }
  std::size_t heater() const { return heater_; }
  const HeaterTuning& told() const { return told_; }

  /// None: nothing is due.
  std::optional<Question> next(BusTime now) const;
  /// To the last question. `value`: what was read.
  void on_answer(BusTime now, AbortCode code, std::uint32_t value);

 private:
  void take_state(BusTime now, std::uint32_t state);
  void take_model();
  void on_stored(BusTime now, AbortCode code);
  void on_silence(BusTime now, AbortCode code);

  HeaterTuning told_;
  std::size_t heater_ = 0;
  double power_w_ = 0;
  BusTime due_{0}, heard_{0}, store_since_{0};
  std::array<std::uint32_t, 4> found_{};  ///< rate mK/s, loss 1e-6/s, lag ms, dead time ms
  std::size_t read_ = 0;                  ///< of them
};

}  // namespace kinebus
