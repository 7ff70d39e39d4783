#include "gateway/fleet/agent.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

namespace kinebus::fleet {
namespace {

/// Who looks at the machines sees by this that the agent lives.
constexpr auto kShowAgain = std::chrono::seconds{5};
/// From a result over the next claim to its start.
constexpr int kMostInATurn = 6;
constexpr double kProgressStep = 0.01;
constexpr const char* kNobodyKnows =
    "the gateway's history does not tell whether it has started: look at the machine, then "
    "'kinebus-fleet release'";

}  // namespace

void ServedMachine::say(const std::string& words) {
  if (words == said_) return;
  said_ = words;
  if (!words.empty()) fmt::print(stderr, "{}: {}\n", gateway_.machine.name, words);
}

void ServedMachine::turn() {
  try {
    for (int done = 0; done < kMostInATurn && look_and_act();) ++done;
    say({});
  } catch (const ClientError& error) {
    link_.reset();
    say(error.what());
    show({.state = "unreachable", .words = error.what(), .job = shown_.job, .progress = shown_.progress});
  } catch (const DatabaseError& error) {
    say(error.what());
  }
}

bool ServedMachine::look_and_act() {
  const auto job = with(queue_, [&](Queue& queue) { return queue.job_of(gateway_.machine.name); });
  if (!link_) link_ = std::make_unique<GatewayLink>(gateway_.reach);
  const GatewayFacts facts = link_->look(job);
  show({.answers = true, .state = facts.state, .job = job ? job->id : 0, .progress = facts.progress});
  return act(decide(job, facts, policy_), job, facts);
}

bool ServedMachine::act(Action action, const std::optional<QueuedJob>& job, const GatewayFacts& facts) {
  switch (action) {
    case Action::kWait:
      return false;
    case Action::kClaim: {
      const auto claimed =
          with(queue_, [&](Queue& queue) { return queue.claim(gateway_.machine, facts.newest_run); });
      // Its ticket is new: what was seen of the gateway just now is all that decides, and it refuses a second
      // start.
      return claimed && act(decide(claimed, facts, policy_), claimed, facts);
    }
    case Action::kHome:
      link_->home();
      return false;
    case Action::kCancelRun:
      link_->cancel();
      return false;
    case Action::kAskOperator:
      with(told_.notes, [&](Queue& queue) { queue.say(gateway_.machine.name, *job, kNobodyKnows); });
      return false;
    default:
      act_on_job(action, *job, facts);
      return true;
  }
}

void ServedMachine::act_on_job(Action action, const QueuedJob& job, const GatewayFacts& facts) {
  const std::string& name = gateway_.machine.name;
  if (action == Action::kStart) {
    const std::string text = with(queue_, [&](Queue& queue) { return queue.text(job); });
    link_->start(job, text);
    // A start is answered when the history has it. An answer that is lost: the next look finds it there.
    return with(told_.notes, [&](Queue& queue) { queue.note_started(name, job); });
  }
  if (action == Action::kUseUp) return link_->use_up(job);
  with(told_.notes, [&](Queue& queue) {
    if (action == Action::kNoteStarted)
      queue.note_started(name, job);
    else if (action == Action::kNoteEnded)
      queue.note_ended(name, job, facts.run->result, facts.run->words);
    else if (action == Action::kNextAttempt)
      queue.next_attempt(name, job);
    else if (action == Action::kNoteNotRun)
      queue.note_not_run(name, job);
  });
  if (action == Action::kNoteEnded || action == Action::kNextAttempt || action == Action::kNoteNotRun)
    link_->forget(job);
}

void ServedMachine::show(MachineView view) {
  const auto now = std::chrono::steady_clock::now();
  const bool same = shown_.answers == view.answers && shown_.state == view.state && shown_.job == view.job &&
                    std::abs(shown_.progress - view.progress) < kProgressStep;
  if (same && now - shown_at_ < kShowAgain) return;
  view.machine = gateway_.machine;
  if (told_.broker != nullptr && !same) told_.broker->show(view);
  told_.views.show(view);
  shown_ = std::move(view);
  shown_at_ = now;
}

void run_agent(const AgentOptions& options, const std::atomic<bool>& quit) {
  std::vector<std::unique_ptr<SharedQueue>> queues;
  for (int i = 0; i < std::max(options.connections, 1); ++i)
    queues.push_back(std::make_unique<SharedQueue>(options.database));
  SharedQueue notes(options.database);
  ViewWriter views(notes);
  const auto broker = options.broker ? std::make_unique<Broker>(*options.broker) : nullptr;
  std::vector<std::unique_ptr<ServedMachine>> machines;
  machines.reserve(options.gateways.size());
  for (const ServedGateway& gateway : options.gateways)
    machines.push_back(std::make_unique<ServedMachine>(
        gateway, *queues[machines.size() % queues.size()],
        Told{.notes = notes, .views = views, .broker = broker.get()}, options.policy));
  std::vector<std::thread> threads;
  threads.reserve(machines.size());
  for (const auto& machine : machines)
    threads.emplace_back([&options, &quit, served = machine.get()] {
      while (!quit) {
        const auto next = std::chrono::steady_clock::now() + options.period;
        served->turn();
        while (!quit && std::chrono::steady_clock::now() < next)
          std::this_thread::sleep_for(std::min(options.period, std::chrono::milliseconds{200}));
      }
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace kinebus::fleet
