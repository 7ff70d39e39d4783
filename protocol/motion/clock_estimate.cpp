#include "protocol/motion/clock_estimate.hpp"

#include <algorithm>
#include <limits>

namespace kinebus {
namespace {

constexpr std::int64_t kHorizonNs = 16'000'000'000;
// A sample further than this from the fit is a mistake (a wrong pairing, a clock that jumped), not latency.
// Half of the shortest period of SYNC.
constexpr std::int64_t kMistakeNs = 2'500'000;
// A window so much shorter than the horizon is a full one, a few SYNCs before one leaves it.
constexpr std::int64_t kLongWindowNs = 1'000'000'000;
// Of fits, some 1.6 s: beside a window of 16 s nothing.
constexpr std::int64_t kSlopeFollows = 32;
constexpr std::int64_t kLongestGapNs = 30'000'000'000;
// So many mistakes one after another mean that the fit is the mistake.
constexpr int kMaxStrangers = 3;
constexpr std::int64_t kMaxSlopePpm = 300;
// While SYNCs come every 5 ms, every eighth one brings a new fit; every one when they come as usual.
constexpr LocalTime kFitPeriod{40'000'000};
constexpr std::int64_t kSettleNs = 100'000'000;  // two periods of SYNC
// Crystals wander: a held estimate degrades by about this, even with a perfect fit.
constexpr std::int64_t kWanderPpb = 100;

// The nanoseconds of stamps, a spread that happens to look thin.
constexpr std::int64_t kLeastErrorNs = 300;

constexpr std::int64_t magnitude(std::int64_t v) {
  return v < 0 ? -v : v;
}

}  // namespace

std::int64_t ClockEstimate::Line::to_bus(std::int64_t local) const {
  // Up to 4.8 hours past the last stamp the rate counts, then a node has long since stopped. The 10 bits
  // dropped are worth 0.3 ns.
  const std::int64_t dl = local - local0;
  const std::int64_t steps =
      std::clamp<std::int64_t>(dl >> 10, -(std::int64_t{1} << 34), std::int64_t{1} << 34);
  return bus0 + dl - ((steps * rate) >> (kRateBits - 10));
}

void ClockEstimate::reset() {
  const Counters counters = counters_;
  *this = ClockEstimate{window_};
  counters_ = counters;
}

void ClockEstimate::on_sync(std::uint8_t counter, LocalTime arrival) {
  if (counter == 0) return;
  if (counter == last_counter_) {
    // The first one counts: it is the one that others may have heard alone, and it is never later than its
    // copy.
    ++counters_.syncs_doubled;
    return;
  }
  last_counter_ = counter;
  Arrival& slot = arrivals_[static_cast<std::size_t>(next_arrival_)];
  if (slot.counter != 0) ++counters_.syncs_unstamped;
  slot = {counter, arrival};
  next_arrival_ = (next_arrival_ + 1) % static_cast<int>(arrivals_.size());
}

ClockEstimate::Update ClockEstimate::on_stamp(const SyncStamp& stamp, LocalTime now) {
  Update update;
  const auto arrival = std::find_if(arrivals_.begin(), arrivals_.end(),
                                    [&](const Arrival& a) { return a.counter == stamp.counter; });
  if (stamp.counter == 0 || arrival == arrivals_.end()) {
    ++counters_.stamps_unmatched;
    return update;
  }
  arrival->counter = 0;
  const std::int64_t bus = stamp.time.count();
  const std::int64_t local = arrival->local.count();

  if (count_ != 0 && stamp.epoch != epoch_) {
    // A new clock: a new cloud of points. The answer goes on by the old one until the new one is good enough.
    count_ = 0;
    joining_ = started_;
  }
  epoch_ = stamp.epoch;
  if (count_ == 0) {
    origin_bus_ = bus;
    origin_delta_ = local - bus;
    strangers_ = 0;
  }
  const Sample sample{bus - origin_bus_, local - bus - origin_delta_};
  // A stamp of long after would leave the 64 bits of residual(), and tells nothing about the line before it.
  const std::int64_t gap = count_ == 0 ? 1 : sample.bus - at(count_ - 1).bus;
  const bool strange = gap <= 0 || gap > kLongestGapNs;
  if (count_ != 0 && (strange || magnitude(residual(sample)) > kMistakeNs)) {
    ++counters_.outliers;
    if (++strangers_ < kMaxStrangers) return update;
    count_ = 0;
    origin_bus_ = bus;
    origin_delta_ = local - bus;
    joining_ = started_;
    strangers_ = 0;
    add({0, 0});
  } else {
    strangers_ = 0;
    add(sample);
  }
  last_local_ = arrival->local;
  last_bus_ = stamp.time;
  ++counters_.stamps_used;
  update.used = true;
  // A fit is the dearest thing that a node does, and one sample more in a full window changes little.
  if (count_ > kMinimumSamples && !joining_ && now - fitted_ < kFitPeriod) return update;
  fitted_ = now;
  fit();

  const std::int64_t here = now.count();
  if (joining_ && count_ >= kMinimumSamples) {
    const std::int64_t before = to_bus(now).count();
    synchronised_ = joining_ = false;
    steer(here);
    update.epoch_joined = true;
    update.epoch_shift = BusTime{to_bus(now).count() - before};
  } else if (!joining_) {
    steer(here);
  }
  return update;
}

void ClockEstimate::add(const Sample& sample) {
  if (count_ == window_) {
    first_ = (first_ + 1) % kWindow;
    --count_;
  }
  samples_[static_cast<std::size_t>((first_ + count_) % kWindow)] = sample;
  ++count_;
  drop_old();
  // Keeps the products of hull() and residual() within 64 bits: times below 2^35, deltas below 2^24.
  if (sample.bus > 30'000'000'000) rebase();
}

void ClockEstimate::drop_old() {
  const std::int64_t newest = at(count_ - 1).bus;
  while (count_ > 2 && newest - at(0).bus > kHorizonNs) {
    first_ = (first_ + 1) % kWindow;
    --count_;
  }
}

void ClockEstimate::rebase() {
  const Sample base = at(0);
  for (int i = 0; i < count_; ++i) {
    Sample& s = samples_[static_cast<std::size_t>((first_ + i) % kWindow)];
    s.bus -= base.bus;
    s.delta -= base.delta;
  }
  origin_bus_ += base.bus;
  origin_delta_ += base.delta;
  offset_ += ((slope_ * base.bus) >> kRateBits) - base.delta;
}

std::int64_t ClockEstimate::residual(const Sample& s) const {
  return s.delta - offset_ - ((slope_ * s.bus) >> kRateBits);
}

/// Lower (or upper) convex hull of the samples, as their places; with `residuals`, only of samples within the
/// limit.
int ClockEstimate::hull(Hull& out, bool lower, const Residuals* residuals,
                        std::int32_t residual_limit) const {
  int size = 0;
  for (int i = 0; i < count_; ++i) {
    if (residuals != nullptr && (*residuals)[static_cast<std::size_t>(i)] > residual_limit) continue;
    const Sample& c = at(i);
    while (size >= 2) {
      const Sample& a = corner(out, size - 2);
      const Sample& b = corner(out, size - 1);
      const std::int64_t turn = (b.delta - a.delta) * (c.bus - a.bus) - (c.delta - a.delta) * (b.bus - a.bus);
      if (lower ? turn < 0 : turn > 0) break;
      --size;
    }
    out[static_cast<std::size_t>(size++)] = static_cast<std::uint16_t>(i);
  }
  return size;
}

/// The least (lower hull) or greatest (upper hull) of delta - slope * bus. Along a hull it falls to one
/// corner and rises from there: the way goes on from `near`, where the last slope had it, and leaves it there
/// for the next.
std::int64_t ClockEstimate::support(const Hull& hull, int size, bool lower, std::int64_t slope,
                                    int& near) const {
  const auto value = [&](int i) {
    const Sample& s = corner(hull, i);
    return s.delta - ((slope * s.bus) >> kRateBits);
  };
  const auto better = [&](std::int64_t a, std::int64_t b) { return lower ? a <= b : a >= b; };
  near = std::clamp(near, 0, size - 1);
  std::int64_t best = value(near);
  const int start = near;
  for (int i = start + 1; i < size; ++i) {
    const std::int64_t next = value(i);
    if (!better(next, best)) break;
    best = next, near = i;
  }
  if (near != start) return best;
  for (int i = start - 1; i >= 0; --i) {
    const std::int64_t next = value(i);
    if (!better(next, best)) break;
    best = next, near = i;
  }
  return best;
}

std::int64_t ClockEstimate::slope_between(const Sample& a, const Sample& b) const {
  constexpr std::int64_t max_slope = (kMaxSlopePpm << kRateBits) / 1'000'000;
  const std::int64_t rise = std::clamp<std::int64_t>(b.delta - a.delta, -(1 << 23), 1 << 23);
  return std::clamp((rise << kRateBits) / (b.bus - a.bus), -max_slope, max_slope);
}

/// The mean latency of all but the far outliers; 2.5 times it holds any latency spread evenly over an
/// interval.
std::int32_t ClockEstimate::latency_limit(const Residuals& residuals) const {
  std::int64_t limit = std::numeric_limits<std::int32_t>::max();
  for (int round = 0; round < 4; ++round) {
    std::int64_t sum = 0;
    std::int32_t used = 0;
    const auto within = static_cast<std::int32_t>(limit);
    for (int i = 0; i < count_; ++i)
      if (const std::int32_t r = residuals[static_cast<std::size_t>(i)]; r <= within) sum += r, ++used;
    const std::int64_t mean = sum / std::max<std::int32_t>(used, 1);
    limit = (round < 3 ? 3 * mean : count_ < 96 ? 5 * mean / 2 : 11 * mean / 5) + 100;
    limit = std::min<std::int64_t>(limit, std::numeric_limits<std::int32_t>::max());
  }
  return static_cast<std::int32_t>(limit);
}

void ClockEstimate::fit() {
  const std::int64_t slope_before = slope_;
  if (count_ < 2) {
    offset_ = 0;  // the one sample is the origin; the slope stays what it was, for a new epoch
    spread_ = 0;
    return;
  }
  Hull low, high;
  const int low_size = hull(low, true, nullptr, 0);

  // First the line that bears the cloud at its middle, to tell outliers by.
  const std::int64_t middle = (at(0).bus + at(count_ - 1).bus) / 2;
  int edge = 0;
  while (edge + 2 < low_size && corner(low, edge + 1).bus < middle) ++edge;
  slope_ = slope_between(corner(low, edge), corner(low, edge + 1));
  int low_near = edge, high_near = 0;
  offset_ = support(low, low_size, true, slope_, low_near);
  // Deltas are below 2^24, slopes below 300 ppm of 2^35: what is larger than 32 bits is the least of them
  // all.
  Residuals residuals;
  for (int i = 0; i < count_; ++i)
    residuals[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(
        std::min<std::int64_t>(residual(at(i)), std::numeric_limits<std::int32_t>::max()));

  // Then the thinnest strip: one of its edges lies on an edge of a hull.
  const int high_size = hull(high, false, &residuals, latency_limit(residuals));
  if (high_size < 2) return;
  std::int64_t best_slope = slope_;
  std::int64_t best_width = std::numeric_limits<std::int64_t>::max();
  const auto consider = [&](std::int64_t slope) {
    const std::int64_t width =
        support(high, high_size, false, slope, high_near) - support(low, low_size, true, slope, low_near);
    if (width < best_width) best_width = width, best_slope = slope;
  };
  // The width is a convex function of the slope: it falls for as long as the lower edge rests left of where
  // the upper one does. On either hull the edge where that turns is found by halving, and it or the one
  // before is the best.
  const auto low_slope = [&](int i) { return slope_between(corner(low, i), corner(low, i + 1)); };
  const auto high_slope = [&](int i) {  // from the last edge on: ascending, too
    return slope_between(corner(high, high_size - 2 - i), corner(high, high_size - 1 - i));
  };
  const auto first_rise = [](int edges, const auto& rises) {
    int from = 0, to = edges - 1;
    while (from < to) {
      const int half = (from + to) / 2;
      if (rises(half))
        to = half;
      else
        from = half + 1;
    }
    return from;
  };
  const int low_turn = first_rise(low_size - 1, [&](int i) {
    support(high, high_size, false, low_slope(i), high_near);
    return corner(low, i + 1).bus >= corner(high, high_near).bus;
  });
  const int high_turn = first_rise(high_size - 1, [&](int i) {
    support(low, low_size, true, high_slope(i), low_near);
    return corner(low, low_near).bus >= corner(high, high_size - 2 - i).bus;
  });
  for (int i = std::max(low_turn - 1, 0); i <= low_turn; ++i) consider(low_slope(i));
  for (int i = std::max(high_turn - 1, 0); i <= high_turn; ++i) consider(high_slope(i));
  // Which strip is the thinnest, one sample more may change from one slope to another. Crystals do not jump:
  // where the window moves on and the strip before is as good, the slope follows slowly.
  slope_ = best_slope;
  if (count_ == window_ || at(count_ - 1).bus - at(0).bus > kHorizonNs - kLongWindowNs) {
    const std::int64_t slope = slope_before + (best_slope - slope_before) / kSlopeFollows;
    const std::int64_t width =
        support(high, high_size, false, slope, high_near) - support(low, low_size, true, slope, low_near);
    if (width - best_width <= 10 * best_width / count_ + kLeastErrorNs) slope_ = slope;
  }
  offset_ = support(low, low_size, true, slope_, low_near);
  spread_ = std::max<std::int64_t>(best_width, 0);
}

void ClockEstimate::steer(std::int64_t now) {
  // The fit, turned round: where the bus clock is at local time `now`. With f = slope: local - bus grows by f
  // for each ns of bus time, so by f / (1 + f) for each ns of local time; f^2 is 1e-7 of f.
  const std::int64_t rate =
      slope_ - static_cast<std::int64_t>(((slope_ >> 8) * (slope_ >> 8)) >> (kRateBits - 16));
  const std::int64_t local_of_origin = origin_bus_ + origin_delta_ + offset_;
  const Line wanted{local_of_origin, origin_bus_, rate};
  const std::int64_t target = wanted.to_bus(now);

  if (!synchronised_) {
    settled_ = steered_ = {now, target, rate};
    settled_local_ = now;
    correction_ = 0;
    started_ = true;
    synchronised_ = count_ >= kMinimumSamples;
    return;
  }
  const std::int64_t from = to_bus(LocalTime{now}).count();
  constexpr std::int64_t most = kSettleNs / 1'000 * kMaxSlewPpb / 1'000'000;
  correction_ = std::clamp(target - from, -most, most);
  const std::int64_t extra = (correction_ << kRateBits) / kSettleNs;
  steered_ = {now, from, rate - extra};
  settled_local_ = now + kSettleNs;
  settled_ = {settled_local_, steered_.to_bus(settled_local_), rate};
  correction_ = magnitude(target - from);
}

BusTime ClockEstimate::to_bus(LocalTime local) const {
  const std::int64_t t = local.count();
  return BusTime{t < settled_local_ ? steered_.to_bus(t) : settled_.to_bus(t)};
}

LocalTime ClockEstimate::to_local(BusTime bus) const {
  const Line& line = bus.count() < settled_.bus0 ? steered_ : settled_;
  // Two rounds of the fixed point local = local0 + db + dl * rate: the rest is rate^2 of the first error.
  const std::int64_t db = bus.count() - line.bus0;
  std::int64_t local = line.local0 + db;
  for (int i = 0; i < 3; ++i) local += bus.count() - line.to_bus(local);
  return LocalTime{local};
}

BusTime ClockEstimate::error_bound(LocalTime now) const {
  if (!synchronised_) return std::chrono::seconds{1};
  const std::int64_t fit_error = 10 * spread_ / std::max(count_, 1) + kLeastErrorNs;
  const std::int64_t span = std::max<std::int64_t>(at(count_ - 1).bus - at(0).bus, 1);
  const std::int64_t age = std::clamp<std::int64_t>((now - last_local_).count(), 0, kHorizonNs * 1000);
  // The fit's slope is worth about four times its error over the window; in ns per 1024 ns << 20 to stay in
  // range.
  const std::int64_t drift_ppb =
      4 * fit_error * 1'000'000 / std::max<std::int64_t>(span / 1'000, 1) + kWanderPpb;
  return BusTime{fit_error + correction_ + age / 1'000 * drift_ppb / 1'000'000};
}

std::int32_t ClockEstimate::rate_ppb() const {
  return static_cast<std::int32_t>((slope_ / 1024 * 1'000'000'000) >> (kRateBits - 10));
}

}  // namespace kinebus
