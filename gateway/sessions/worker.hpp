#pragma once
// Work that may wait for the disk, or takes long, is done beside the control loop: one piece after the other,
// in the order given. The daemon has a thread for it (gateway/io/worker_thread.hpp); tests do it when they
// choose.

#include <functional>
#include <memory>
#include <utility>

namespace kinebus {

class Worker {
 public:
  virtual ~Worker() = default;
  /// `work` runs beside the loop and touches nothing of it; `done` runs afterwards within the loop.
  virtual void post(std::function<void()> work, std::function<void()> done) = 0;

  /// Work with a result, which `done` takes.
  template <typename Work, typename Done>
  void ask(Work work, Done done) {
    using Answer = decltype(work());
    auto answer = std::make_shared<std::unique_ptr<Answer>>();
    post([answer, work = std::move(work)]() mutable { *answer = std::make_unique<Answer>(work()); },
         [answer, done = std::move(done)]() mutable { done(std::move(**answer)); });
  }
};

}  // namespace kinebus
