#pragma once
// Lets work of streams begin that does not come by a stream: somebody at a listener, what the worker has
// done. It counts as theirs, and does not begin when theirs does not (gateway/io/stream_hub.hpp).

namespace kinebus {

class WorkGate {
 public:
  virtual ~WorkGate() = default;
  /// False: not now; the loop's next turns ask again.
  virtual bool begins() = 0;
  virtual void ends() = 0;
};

}  // namespace kinebus
