#pragma once
// What an operator changes of motors while the machine is up: run and hold current (M906), and the node's own
// measurement of a winding. Over SDO while everything rests, since nodes refuse parameters in motion. The
// description at hand follows, and with it bring-up and the watch over parameters; the machine file does not.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/description/machine_description.hpp"
#include "gateway/motors/parameter_watch.hpp"
#include "gateway/result.hpp"
#include "gateway/status/event_queue.hpp"
#include "gateway/status/refusal.hpp"
#include "protocol/time.hpp"

namespace kinebus {

/// Until the gateway is started anew; then the machine file's count again.
struct MotorSetting {
  std::size_t joint = 0;  ///< index into MachineDescription::joints
  /// mA, peak of a phase. None: as it is, or for the hold current, the file's share of the new run current.
  std::optional<double> run_ma{}, hold_ma{};
};

class MotorSettings {
 public:
  MotorSettings(MachineDescription& machine, std::deque<NodeLink>& links, ParameterWatch& parameters,
                EventQueue& events);

  /// Of all motors that are named, or of none. They have them when everything next rests.
  Result<void, Refusal> set(const std::vector<MotorSetting>& asked);
  /// The node measures the joint's winding; what it finds is told, and the file's values count again.
  Result<void, Refusal> tune(std::size_t joint);

  /// Currents were asked for that the motor does not have yet.
  bool waits() const;
  /// A node and the description may differ: nobody else judges them.
  bool busy() const { return work_.has_value(); }
  /// The joint that is measured: nothing may move.
  std::optional<std::size_t> tuned() const;

  /// It writes what was asked for with everything else.
  void bring_up_begins(BusTime now);
  /// `may_ask`: nothing else is asked of the nodes; `rests`: and nothing moves.
  void on_time(BusTime now, bool may_ask, bool rests);

 private:
  struct Currents {
    std::uint16_t run_ma = 0, hold_ma = 0;
  };
  enum class Step : std::uint8_t { kWrite, kTuneBegins, kTuneRuns, kTuneRead };
  static constexpr std::size_t kTuned = 3;  ///< resistance, inductance, encoder offset
  struct Work {
    std::size_t joint = 0, node = 0;
    Step step = Step::kWrite;
    std::vector<ParameterWrite> writes{};
    std::size_t next = 0;  ///< of `writes`, or of what is read
    std::optional<Currents> currents{};
    std::array<std::int64_t, kTuned> found{};
    std::optional<ObjectAddress> asked{};  ///< the answer is on its way
    BusTime due{0}, begun{0};
  };

  std::optional<std::size_t> link_of(const JointDescription& joint) const;
  void begin(BusTime now);
  void ask();
  void take(BusTime now, const SdoResult& answer);
  void written(BusTime now, const SdoResult& answer);
  void measured(BusTime now, const SdoResult& answer);
  void restore_tuned(BusTime now);
  void finish(BusTime now);
  void fail(BusTime now, Sentence why);

  MachineDescription& machine_;
  std::deque<NodeLink>& links_;
  ParameterWatch& parameters_;
  EventQueue& events_;
  std::vector<Currents> file_;                   ///< by joint: what the machine file says
  std::vector<std::optional<Currents>> wanted_;  ///< by joint
  std::optional<std::size_t> to_tune_;
  std::optional<Work> work_;
};

}  // namespace kinebus
