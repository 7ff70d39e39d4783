#include "gateway/jobs/bus_load.hpp"

#include <algorithm>

namespace kinebus {

void BusLoad::advance(BusTime now) {
  const std::int64_t bucket = now.count() / kBucketNs;
  if (bucket_ < 0) {
    bucket_ = first_bucket_ = bucket;
    return;
  }
  const std::int64_t last = std::min(bucket, bucket_ + kBuckets);
  for (std::int64_t b = bucket_ + 1; b <= last; ++b) {
    auto& slot = buckets_[static_cast<std::size_t>(b % kBuckets)];
    window_bits_ -= slot;
    slot = 0;
  }
  bucket_ = std::max(bucket_, bucket);
}

void BusLoad::add(BusTime when, std::int64_t bits) {
  advance(when);
  // A frame reported a little late belongs to its own bucket, as long as that is still in the window.
  const std::int64_t bucket = std::max(when.count() / kBucketNs, bucket_ - kBuckets + 1);
  buckets_[static_cast<std::size_t>(bucket % kBuckets)] += bits;
  window_bits_ += bits;
  total_bits_ += bits;
  peak_bits_ = std::max(peak_bits_, window_bits_);
}

void BusLoad::skip(BusTime until, std::int64_t bits) {
  advance(until);
  total_bits_ += bits;
}

double BusLoad::mean() const {
  if (bucket_ < 0) return 0;
  const double seconds = static_cast<double>((bucket_ - first_bucket_ + 1) * kBucketNs) * 1e-9;
  return static_cast<double>(total_bits_) / (kBusBitsPerSecond * seconds);
}

}  // namespace kinebus
