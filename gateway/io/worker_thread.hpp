#pragma once
// The one thread beside the control loop: a disk may keep it waiting for seconds, never the loop.

#include <deque>
#include <functional>
#include <thread>

#include "gateway/io/event_loop.hpp"
#include "gateway/io/work_gate.hpp"
#include "gateway/sessions/worker.hpp"
#include "protocol/host/inheriting_mutex.hpp"
#include "protocol/host/wake_up.hpp"

namespace kinebus {

class WorkerThread : public Worker {
 public:
  /// Made before the process asks for real-time priority: the thread does not inherit it.
  explicit WorkerThread(EventLoop& loop);
  /// Does what was posted before, then ends. What was done meanwhile is not told any more.
  ~WorkerThread() override;
  WorkerThread(const WorkerThread&) = delete;
  WorkerThread& operator=(const WorkerThread&) = delete;

  /// What is done is told through it; `fd` below is what brings it.
  void pass(WorkGate& gate) { gate_ = &gate; }
  int fd() const { return event_; }

  void post(std::function<void()> work, std::function<void()> done) override;

 private:
  struct Piece {
    std::function<void()> work, done;
  };
  void run();
  void wake_loop() const;
  void take_done();

  EventLoop& loop_;
  int event_ = -1;
  WorkGate* gate_ = nullptr;
  InheritingMutex mutex_;
  WakeUp wake_;
  std::deque<Piece> waiting_;               // by mutex_
  std::deque<std::function<void()>> done_;  // by mutex_
  bool ends_ = false;                       // by mutex_
  std::deque<std::function<void()>> told_;  ///< of those done, what is told next
  std::thread thread_;
};

}  // namespace kinebus
