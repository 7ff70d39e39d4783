#pragma once
// Places around which no two bodies come too near, of those that a path has been at: jobs come back to the
// same places line after line and layer after layer.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/bodies/collision_model.hpp"

namespace kinebus::bodies {

class ClearPlaces {
 public:
  using Place = CollisionModel::Place;
  /// What comes no farther than that from `middle` is clear.
  struct Room {
    Place middle{};
    double mm = 0;
  };

  void forget() { rooms_.assign(kRooms, {}); }
  void keep(const Room& room) {
    const Place& m = room.middle;
    const auto narrow = [](double x) { return static_cast<float>(x); };
    rooms_[slot(m)] = {narrow(m.point.x), narrow(m.point.y), narrow(m.point.z), narrow(m.turn_mm),
                       narrow(room.mm - kRounding_mm)};
  }
  /// One that `place` is in.
  std::optional<Room> around(const Place& place) const {
    const Kept& k = rooms_[slot(place)];
    const Room room{{{k.x, k.y, k.z}, k.turn_mm, place.lever_mm}, k.mm};
    if (!(CollisionModel::apart_mm(place, room.middle) < room.mm)) return std::nullopt;
    return room;
  }

 private:
  // A layer of 200 x 200 mm has 2500 cells; as few as a room mostly has them all around its middle.
  static constexpr double kCell_mm = 4;
  static constexpr std::size_t kRooms = 4096;
  /// Of float, some metres from the zero, in four coordinates.
  static constexpr double kRounding_mm = 2e-3;
  struct Kept {
    float x = 0, y = 0, z = 0, turn_mm = 0, mm = 0;
  };
  /// The room of a place's cell. Cells share them: whose it is tells the room itself.
  static std::size_t slot(const Place& place) {
    const auto cell = [](double mm, std::uint64_t odd) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(mm / kCell_mm))) * odd;
    };
    const std::uint64_t mixed = cell(place.point.x, 1) + cell(place.point.y, 64) +
                                cell(place.point.z, 0x9E3779B97F4A7C15u) +
                                cell(place.turn_mm, 0xC2B2AE3D27D4EB4Fu);
    return (mixed ^ (mixed >> 32u)) % kRooms;
  }

  std::vector<Kept> rooms_ = std::vector<Kept>(kRooms);
};

}  // namespace kinebus::bodies
