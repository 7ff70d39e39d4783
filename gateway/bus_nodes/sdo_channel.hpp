#pragma once
// SDO requests to one node, one after the other, with timeout and repetition; the results come in the same
// order.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "gateway/bus_nodes/node_configuration.hpp"
#include "gateway/sentence.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/canopen/abort_code.hpp"
#include "protocol/canopen/sdo_client.hpp"
#include "protocol/time.hpp"

namespace kinebus {

struct SdoResult {
  ObjectAddress address;
  bool read = false;
  AbortCode abort = AbortCode::kNone;  ///< kTimeout: no answer, after all repetitions
  std::int64_t value = 0;              ///< what was read
};
/// "node 2, object 6098h:0: value too high"
Sentence to_string(std::uint8_t node, const SdoResult& result);

class SdoChannel {
 public:
  struct Counters {
    std::uint32_t aborts = 0, timeouts = 0;
  };

  explicit SdoChannel(std::uint8_t node_id);

  /// Numbers of up to 8 bytes.
  void read(ObjectAddress address);
  void write(const ParameterWrite& write);
  /// Nothing is under way and all results were fetched.
  bool idle() const { return requests_.empty() && results_.empty(); }
  std::optional<SdoResult> next_result();
  /// A read for displays, when the channel is idle: tried once, its result comes apart from the others.
  void glance(ObjectAddress address);
  /// A write when the channel is idle, beside whatever is asked for next: its result comes as a glance's.
  void write_apart(const ParameterWrite& write);
  /// Of this object, on either axis.
  std::optional<SdoResult> next_glance(ObjectAddress base);
  /// Forgets all requests and results.
  void abandon();

  void on_frame(BusTime now, const CanFrame& frame);
  void on_time(BusTime now);
  std::optional<CanFrame> next_frame(BusTime now);
  BusTime next_deadline() const { return client_.next_deadline(); }
  const Counters& counters() const { return counters_; }

 private:
  /// Three attempts of half a second: a node that stores parameters answers late, one that restarts not at
  /// all.
  static constexpr int kAttempts = 3;
  /// Disturbed ones cost no time; on a bus that doubles nearly every frame three are too few.
  static constexpr int kDisturbedAttempts = 10;
  struct Request {
    ObjectAddress address;
    bool read = false;
    bool apart = false;  ///< its result does not come in the order of the others
    std::uint8_t size = 0;
    std::array<std::uint8_t, 8> bytes{};
  };
  void begin(BusTime now);
  void settle();

  std::uint8_t node_id_;
  SdoClient client_;
  std::deque<Request> requests_;  ///< the first is under way when attempts_ > 0
  std::deque<SdoResult> results_;
  std::optional<SdoResult> glanced_;
  std::array<std::uint8_t, 8> buffer_{};
  int attempts_ = 0;
  Counters counters_;
};

}  // namespace kinebus
