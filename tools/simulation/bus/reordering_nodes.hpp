#pragma once
// An adapter between the gateway and the bus that gives frames on in another order, either way, as gs_usb
// does on kernels before 6.6 and candleLight before 2.0: of those that are under way together any may come
// first.

#include <algorithm>
#include <deque>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "tools/simulation/bus/node_machine.hpp"

namespace kinebus {

class ReorderingNodes final : public NodeMachine {
 public:
  /// Of up to `window` frames in a row, 1 or more; 1: nothing is changed.
  ReorderingNodes(std::unique_ptr<NodeMachine> nodes, int window, std::uint64_t seed)
      : nodes_(std::move(nodes)), window_(static_cast<std::size_t>(window)), random_(seed) {}

  bool can_send() const override { return out_.ready.empty(); }
  void send(BusTime now, const CanFrame& frame) override {
    now_ = std::max(now_, now);
    add(out_, frame);
    pass_on();
  }
  std::optional<Received> receive() override {
    if (in_.ready.empty()) return std::nullopt;
    const Received got = in_.ready.front();
    in_.ready.pop_front();
    return got;
  }
  BusTime next_event() const override {
    return in_.ready.empty() ? std::min({nodes_->next_event(), in_.due, out_.due}) : now_;
  }
  bool advance(BusTime now) override {
    const BusTime until = std::min({now, in_.due, out_.due});
    const bool done = nodes_->advance(until);
    while (const auto got = nodes_->receive()) {
      now_ = std::max(now_, got->when);
      // That it was sent, and when, the controller tells by itself.
      if (got->own)
        in_.ready.push_back(*got);
      else
        add(in_, *got);
    }
    if (done) now_ = std::max(now_, until);
    if (in_.due <= now_) release(in_);
    if (out_.due <= now_) release(out_);
    for (Received& got : in_.ready)
      if (!got.own) got.when = now_;
    pass_on();
    return done && until == now && in_.ready.empty();
  }

  double true_counts(int node, int axis, BusTime at) override { return nodes_->true_counts(node, axis, at); }
  PathTime path_time(int node, BusTime at) override { return nodes_->path_time(node, at); }
  int node_count() const override { return nodes_->node_count(); }
  const BusModel& bus() const override { return nodes_->bus(); }
  void set_input(int node, BusTime at, int input, bool level) override {
    nodes_->set_input(node, at, input, level);
  }
  heat::HeatPlant* heated(int node) override { return nodes_->heated(node); }

 private:
  /// Frames that come so soon behind one another are under way together.
  static constexpr BusTime kTogether = std::chrono::microseconds{500};

  template <typename Frame>
  struct Way {
    std::vector<Frame> held;
    std::deque<Frame> ready;
    std::size_t wanted = 1;
    BusTime due = BusTime::max();
  };

  template <typename Frame>
  void add(Way<Frame>& way, const Frame& frame) {
    if (way.held.empty()) {
      way.wanted = 1 + random_() % window_;
      way.due = now_ + kTogether;
    }
    way.held.push_back(frame);
    if (way.held.size() >= way.wanted) release(way);
  }
  template <typename Frame>
  void release(Way<Frame>& way) {
    std::shuffle(way.held.begin(), way.held.end(), random_);
    way.ready.insert(way.ready.end(), way.held.begin(), way.held.end());
    way.held.clear();
    way.due = BusTime::max();
  }
  void pass_on() {
    for (; !out_.ready.empty() && nodes_->can_send(); out_.ready.pop_front())
      nodes_->send(now_, out_.ready.front());
  }

  std::unique_ptr<NodeMachine> nodes_;
  std::size_t window_;
  std::mt19937_64 random_;
  Way<CanFrame> out_;
  Way<Received> in_;
  BusTime now_{0};
};

}  // namespace kinebus
