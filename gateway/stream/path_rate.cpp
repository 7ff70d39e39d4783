#include "gateway/stream/path_rate.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {
namespace {

/// So late a node still comes to the path time that was meant (PathClock::Options::rewind).
constexpr BusTime kCaughtUp = PathClock::Options{}.rewind;

std::uint8_t ramp_2ms(std::chrono::milliseconds ramp) {
  return static_cast<std::uint8_t>(std::clamp<std::int64_t>((ramp.count() + 1) / 2, 1, 255));
}

}  // namespace

std::uint16_t PathRate::q15(double rate) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(rate, 0.0, 1.0) * kFullRateQ15));
}

/// Whole microseconds travel; commands take effect in the order in which they were given.
BusTime PathRate::start(BusTime lead, BusTime now) const {
  const BusTime start = std::max(now + lead, last_start_ + BusTime{1});
  return BusTime{(start.count() + 999) / 1000 * 1000};
}

void PathRate::send(RateCommand command, BusTime lead, BusTime now) {
  counter_ = (counter_ + 1) & 0xF;
  command.counter = counter_;
  command.start = start(lead, now);
  last_start_ = command.start;
  clock_.apply(command, now);
  put_out(command, now);
  ++counters_.commands;
}

void PathRate::put_out(const RateCommand& command, BusTime now) {
  out_.push_back(encode(command));
  unsent_.push_back(out_.back());
  for (int i = 1; i <= kRepeats; ++i) repeats_.push_back({now + i * kRepeatAfter, out_.back()});
  std::stable_sort(repeats_.begin(), repeats_.end(),
                   [](const Repeat& a, const Repeat& b) { return a.due < b.due; });
}

/// Behind a stop it means nothing, and a node that hears of it then, be it once more, takes it for an error.
void PathRate::withdraw_from(BusTime stop_start, BusTime now) {
  const auto means_nothing = [&](const CanFrame& frame) {
    const auto command = decode_rate_command(frame, now);
    return command && command->sets_rate() && command->start >= stop_start;
  };
  std::erase_if(out_, means_nothing);
  std::erase_if(unsent_, means_nothing);
  std::erase_if(repeats_, [&](const Repeat& repeat) { return means_nothing(repeat.frame); });
}

std::optional<CanFrame> PathRate::next_repeat(BusTime now) {
  if (repeats_.empty() || repeats_.front().due > now) return std::nullopt;
  const CanFrame frame = repeats_.front().frame;
  repeats_.pop_front();
  return frame;
}

void PathRate::request(double rate, std::chrono::milliseconds full_ramp, BusTime now, bool hurry) {
  request({.kind = RateCommand::Kind::kRate, .rate_q15 = q15(rate), .full_ramp_2ms = ramp_2ms(full_ramp)},
          hurry && !clock_.at_rest(now) ? options_.lead : options_.start_lead, now);
}

void PathRate::begin_at(double rate, BusTime start, BusTime now) {
  constexpr std::chrono::milliseconds kAtOnce{2};
  request({.kind = RateCommand::Kind::kRate, .rate_q15 = q15(rate), .full_ramp_2ms = ramp_2ms(kAtOnce)},
          std::max(start - now, options_.lead), now);
}

/// Finding the ramp takes some of it.
BusTime PathRate::smooth_lead(BusTime now) const {
  return clock_.at_rest(now) ? options_.start_lead : 2 * options_.lead;
}

void PathRate::request_smooth(double rate, std::chrono::milliseconds full_ramp, BusTime now) {
  request({.kind = RateCommand::Kind::kSmooth, .rate_q15 = q15(rate), .full_ramp_2ms = ramp_2ms(full_ramp)},
          smooth_lead(now), now);
}

PathClock PathRate::with_smooth(double rate, std::chrono::milliseconds full_ramp, BusTime now) const {
  PathClock clock = clock_;
  clock.apply({.kind = RateCommand::Kind::kSmooth,
               .rate_q15 = q15(rate),
               .full_ramp_2ms = ramp_2ms(full_ramp),
               .start = start(smooth_lead(now), now)},
              now);
  return clock;
}

void PathRate::request(RateCommand command, BusTime lead, BusTime now) {
  if (clock_.stop_latched() || command.rate_q15 == target_q15_) return;
  target_q15_ = command.rate_q15;
  send(command, lead, now);
}

void PathRate::stop(BusTime now) {
  target_q15_ = 0;
  // A stop does not queue up behind a rate command that is still ahead.
  last_start_ = BusTime{0};
  send({.kind = RateCommand::Kind::kStop, .rate_q15 = 0, .full_ramp_2ms = ramp_2ms(options_.stop_ramp)}, now);
  withdraw_from(last_start_, now);
}

void PathRate::on_stop_request(const StopRequest& request, BusTime now) {
  target_q15_ = 0;
  const auto outcome = clock_.stop_at(request.start, ramp_2ms(options_.stop_ramp), now);
  if (outcome == PathClock::Outcome::kDuplicate) return;
  // For a node that has not heard the request: the same stop, of the same instant.
  counter_ = (counter_ + 1) & 0xF;
  put_out({.kind = RateCommand::Kind::kStop,
           .counter = counter_,
           .full_ramp_2ms = ramp_2ms(options_.stop_ramp),
           .start = request.start},
          now);
  withdraw_from(request.start, now);
}

void PathRate::clear(BusTime now) {
  target_q15_ = 0;
  send({.kind = RateCommand::Kind::kClear, .rate_q15 = 0, .full_ramp_2ms = 1}, now);
}

std::optional<CanFrame> PathRate::next_frame(BusTime now) {
  if (out_.empty()) return std::nullopt;
  const auto command = decode_rate_command(out_.front(), now);
  if (command && command->kind == RateCommand::Kind::kStop && command->start < now - kCaughtUp) {
    const CanFrame late = out_.front();
    out_.pop_front();
    std::erase(unsent_, late);
    std::erase_if(repeats_, [&](const Repeat& repeat) { return repeat.frame == late; });
    last_start_ = BusTime{0};
    send(*command, now);
    std::rotate(out_.begin(), out_.end() - 1, out_.end());
  }
  const CanFrame frame = out_.front();
  out_.pop_front();
  return frame;
}

void PathRate::on_frame_sent(BusTime when, const CanFrame& frame) {
  if (frame.id != kRateCobId) return;
  std::erase(unsent_, frame);
  if (const auto command = decode_rate_command(frame, when); command && command->start < when)
    ++counters_.late;
}

}  // namespace kinebus
