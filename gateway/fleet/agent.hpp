#pragma once
// Serves gateways: each has a thread that looks at queue and gateway again and again, and does what decide()
// says. It remembers nothing that matters; what breaks is looked at anew in the next turn.

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/fleet/decision.hpp"
#include "gateway/fleet/gateway_link.hpp"
#include "gateway/fleet/gateways_file.hpp"
#include "gateway/fleet/outward/broker.hpp"
#include "gateway/fleet/queue.hpp"
#include "gateway/fleet/view_writer.hpp"

namespace kinebus::fleet {

/// What the machines of an agent share.
struct Told {
  SharedQueue& notes;  ///< for what has happened: nobody waits there for a claim and its disk
  ViewWriter& views;
  Broker* broker = nullptr;  ///< nullptr: there is none
};

class ServedMachine {
 public:
  ServedMachine(const ServedGateway& gateway, SharedQueue& queue, const Told& told, const Policy& policy)
      : gateway_(gateway), queue_(queue), told_(told), policy_(policy) {}

  /// Looks, and does what is to be done until there is nothing. Never throws for what the outside does.
  void turn();

 private:
  /// `work(queue)` with the queue to itself.
  template <typename Work>
  static auto with(SharedQueue& shared, Work work) {
    const std::lock_guard lock(shared.busy);
    return work(shared.queue);
  }
  /// False: there is nothing to be done now.
  bool look_and_act();
  bool act(Action action, const std::optional<QueuedJob>& job, const GatewayFacts& facts);
  void act_on_job(Action action, const QueuedJob& job, const GatewayFacts& facts);
  /// Tells broker and queue, when it has changed.
  void show(MachineView view);
  void say(const std::string& words);

  ServedGateway gateway_;
  SharedQueue& queue_;
  Told told_;
  Policy policy_;
  std::unique_ptr<GatewayLink> link_;
  std::string said_;  ///< the last words, so that a long break is told once
  MachineView shown_{};
  std::chrono::steady_clock::time_point shown_at_{};
};

struct AgentOptions {
  std::string database;
  std::vector<ServedGateway> gateways{};
  Policy policy{};
  std::chrono::milliseconds period{1000};
  int connections = 4;  ///< for looks and claims; one more is for notes
  std::optional<Broker::Options> broker{};
};

/// Returns soon after `quit` is set.
void run_agent(const AgentOptions& options, const std::atomic<bool>& quit);

}  // namespace kinebus::fleet
