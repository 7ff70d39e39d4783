#include "node_firmware/heat/filament_watch.hpp"

#include <algorithm>
#include <utility>

namespace kinebus::heat {
namespace {

/// A switch bounces for less: 50 ms.
constexpr std::uint32_t kSettled = 5;
/// No extruder feeds so much between two words of the master: the count has begun anew.
constexpr std::int32_t kNewCount = 100'000;

}  // namespace

void FilamentWatch::configure(const FilamentSettings& settings) {
  settings_ = settings;
  alike_ = 0;
  known_ = false;
  seen_ = 0;
  reset();
  if (settings_.kind != FilamentKind::kMotion) state_ = FilamentState::kInOrder;
}

void FilamentWatch::reset() {
  if (settings_.kind == FilamentKind::kMotion) state_ = FilamentState::kInOrder;
  begin();
}

void FilamentWatch::begin() {
  back_ = 0;
  edges_ = still_ = 0;
  parts_.fill({});
  part_ = full_ = 0;
}

void FilamentWatch::on_sample(bool level, std::uint32_t edges) {
  if (settings_.kind == FilamentKind::kMotion) {
    edges_ += edges;
    seen_ += edges * settings_.um_per_edge;
  }
  if (settings_.kind != FilamentKind::kSwitch) return;
  alike_ = level == level_ ? std::min(alike_ + 1, kSettled) : 1;
  level_ = level;
  if (alike_ >= kSettled)
    state_ = level != settings_.inverted ? FilamentState::kInOrder : FilamentState::kOut;
}

void FilamentWatch::on_commanded(std::int32_t um) {
  const auto step =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(um) - static_cast<std::uint32_t>(commanded_));
  commanded_ = um;
  if (!std::exchange(known_, true) || step > kNewCount || step < -kNewCount) return begin();
  if (step == 0) return;
  const std::uint32_t passed = std::exchange(edges_, 0u) * settings_.um_per_edge;
  back_ = std::min(back_ - step, kNewCount);
  if (back_ >= 0) return;  // nothing new is fed; the wheel turned back and forth
  const auto forward = static_cast<std::uint32_t>(-std::exchange(back_, 0));
  if (settings_.kind == FilamentKind::kMotion && state_ == FilamentState::kInOrder) judge(forward, passed);
}

void FilamentWatch::judge(std::uint32_t forward, std::uint32_t passed) {
  still_ = passed != 0 ? 0 : still_ + forward;
  if (still_ >= settings_.stands_um + settings_.um_per_edge) {
    state_ = FilamentState::kStands;
    return;
  }
  parts_[part_].fed += forward;
  parts_[part_].passed += passed;
  if (parts_[part_].fed < settings_.slips_um / kParts) return;
  full_ = std::min(full_ + 1, kParts);
  Part all;
  for (const Part& part : parts_) {
    all.fed += part.fed;
    all.passed += part.passed;
  }
  part_ = (part_ + 1) % kParts;
  parts_[part_] = {};
  // The edge that is nearly there counts for the filament.
  if (full_ == kParts && all.passed + settings_.um_per_edge < all.fed / 100 * settings_.least_share)
    state_ = FilamentState::kSlips;
}

}  // namespace kinebus::heat
