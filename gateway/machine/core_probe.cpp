// Probing: what is asked of the probe's node, and the rest behind the contact in which queues are emptied and
// positions are read.

#include <algorithm>
#include <utility>

#include "gateway/machine/core.hpp"

namespace kinebus {

/// The probe's requests, one at a time, between those of others.
void Gateway::Core::serve_probe() {
  ContactProbe* const probe = devices_.probe();
  if (probe == nullptr || !runner_->probing() || rest_.reading()) {
    probe_asked_ = false;
    return;
  }
  const auto link = std::find_if(links_.begin(), links_.end(), [&](const NodeLink& each) {
    return each.id() == machine_.probe.place.node_id;
  });
  if (link == links_.end()) return;
  SdoChannel& sdo = link->sdo();
  if (probe_asked_) {
    const auto answer = sdo.next_result();
    if (!answer) return;
    probe_asked_ = false;
    probe->on_reply(now_, answer->abort == AbortCode::kNone ? std::optional(answer->value) : std::nullopt);
    runner_->look_at_probe(now_);
  }
  if (!sdo.idle()) return;
  const auto request = probe->next_request();
  if (!request) return;
  probe_asked_ = true;
  if (request->read)
    sdo.read(request->address);
  else
    sdo.write({request->address, request->size, request->value});
}

Result<void, Refusal> Gateway::Core::on(command::MovePin& asked) {
  if (auto done = heat_.move_pin(asked.order); !done) return done;
  pin_by_hand_ = true;
  return {};
}

/// Where the pin has come to while no job looks at it: what was asked for by hand, and what has failed.
void Gateway::Core::tell_of_pin() {
  using Pin = ContactProbe::Pin;
  const ContactProbe* const probe = devices_.probe();
  const Pin pin = probe == nullptr || probe->absent() || runner_->active() ? Pin::kNone : probe->pin();
  if (std::exchange(pin_told_, pin) == pin) return;
  if (pin == Pin::kFailed) events_.message(now_, probe->pin_words());
  if (pin == Pin::kOut && pin_by_hand_) events_.message(now_, say("the probe's pin is out"));
  if (pin == Pin::kIn && pin_by_hand_) events_.message(now_, say("the probe's pin is in"));
  if (pin != Pin::kMoves) pin_by_hand_ = false;
}

/// Path time rests behind a contact.
void Gateway::Core::step_probed() {
  if (!std::exchange(probe_rests_, true)) rest_.begin(now_);
  if (rest_.settled(now_)) rest_.read(now_, Rest::After::kProbe);
}

/// Positions are read and queues are empty.
void Gateway::Core::finish_probe() {
  probe_rests_ = false;
  const Result<Pose, Refusal> stand =
      position_.homed() ? machine_pose()
                        : Result<Pose, Refusal>(refused(say("a node has lost its position")));
  Runner::Outcome outcome = Runner::Outcome::kFailed;
  if (stand) outcome = runner_->probed(*stand);
  if (outcome != Runner::Outcome::kFailed) return;
  events_.alarm(now_, AlarmCode::kJobError, stand ? runner_->failure().words : stand.error().words);
  stop_all(true);
}

/// A stop in the middle of it: nobody knows what it would have measured.
void Gateway::Core::give_up_probing() {
  probe_rests_ = false;
  Runner& job = print_.runner();
  if (!job.probing()) return;
  events_.message(now_, say("the job ends: it was stopped while it probed"), job.line(now_));
  position_.lose_stream();
  recovery_.fail_job();
}

void Gateway::Core::give_up_thread() {
  Runner& job = print_.runner();
  if (!job.cuts_thread()) return;
  events_.message(now_, say("the job ends: it was stopped in a thread, which has to be cut in one go"),
                  job.line(now_));
  position_.lose_stream();
  recovery_.fail_job();
}

}  // namespace kinebus
