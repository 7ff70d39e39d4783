#pragma once
// What machines do goes into the queue in batches, on a thread of its own: one statement for all that changed
// since the last one. What a broken database did not take is told again, as it is then.

#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "gateway/fleet/machine_view.hpp"
#include "gateway/fleet/queue.hpp"

namespace kinebus::fleet {

/// A connection to the queue, for one thread at a time.
struct SharedQueue {
  explicit SharedQueue(const std::string& database) : queue(database) {}
  std::mutex busy;
  Queue queue;
};

class ViewWriter {
 public:
  /// `to` outlives it.
  explicit ViewWriter(SharedQueue& to);
  ~ViewWriter();
  ViewWriter(const ViewWriter&) = delete;
  ViewWriter& operator=(const ViewWriter&) = delete;

  /// Soon written; only the newest of each machine is.
  void show(const MachineView& view);

 private:
  void run();
  void write_all();

  SharedQueue& to_;
  std::mutex busy_;
  std::map<std::string, MachineView> waiting_;
  std::atomic<bool> quit_{false};
  std::thread thread_;
};

}  // namespace kinebus::fleet
