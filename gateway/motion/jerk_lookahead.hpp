#pragma once
// The speed profile with limited jerk: stretches of constant speed, and ramps between them that pass over any
// number of pieces. Each ramp begins and ends without acceleration and keeps the least acceleration and jerk
// of the pieces that it passes.
//
// The piece with the lowest cap is passed at that cap, if the speeds at both ends of the stretch under
// consideration can be joined with it; what is before and after it is then planned in the same way, by
// itself. Where no cap can be reached the stretch is one ramp up and one down. So no speed found is ever too
// high for what comes later.
//
// A lone bend (jerk_window.hpp) has a higher cap at which it is passed at constant speed, with ramps beside
// it; where there is no room for these, the bend is planned with its lower cap, over which ramps may lie.
//
// Streaming: the end of what is known is planned as a stop. What is given out ends at the last place where a
// cap is reached before that stop: nothing that follows would have made it faster before, but for the choice
// of ramps next to it. A full window in which no cap is reached gives out its first half. Slow pieces that
// come to be known later may be too near for the speed that was given out, as their own bounds count for the
// whole ramp to them: then the next ramp of the plan before, which ends in a stop, is kept.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gateway/motion/jerk_window.hpp"
#include "gateway/motion/lookahead.hpp"
#include "gateway/motion/speed_ramp.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus {

class JerkLookahead {
 public:
  /// Plans what `path` holds; its own passes are not used.
  explicit JerkLookahead(Lookahead& path) : path_(&path) {}

  /// The next phase; false: feed more, or finish. `early`: also while the window is not full.
  bool next(Phase& phase, bool early);
  /// Time of what next() has still to give, s: to a stop at the end of what is known; and of the part that
  /// nothing added later can change.
  Lookahead::Ahead ahead();
  std::uint64_t forced() const { return forced_; }
  void clear();

 private:
  /// A ramp, or a stretch of constant speed. Positions count from where the path last began or was cleared.
  struct Part {
    double from = 0, to = 0;
    SpeedRamp ramp;       ///< from() == to(): constant speed
    bool capped = false;  ///< constant speed at the cap of a piece
    double duration_s() const {
      return ramp.from() == ramp.to() ? (to - from) / ramp.from() : ramp.duration_s();
    }
  };
  struct Stretch {
    double from = 0, to = 0;
    double v0 = 0, v1 = 0;
    bool plateau = false;  ///< to be passed at v0, which is a cap
    SpeedRamp ramp{};
    bool ramped = false;  ///< `ramp` is all of it
  };
  /// Ramps at both ends of a stretch, and the pieces that they pass.
  struct Fit {
    SpeedRamp up, down;
    double cruise_from = 0, cruise_to = 0;
    bool fits = false;
    double room() const { return cruise_to - cruise_from; }  ///< mm; negative: what is lacking
  };
  struct Peak {
    double speed = 0;
    Fit fit;
  };

  void plan();
  void solve(const Stretch& stretch);
  Fit fit(const Stretch& stretch, std::size_t first, std::size_t last, double speed) const;
  bool keeps_caps(const Stretch& stretch, std::size_t first, std::size_t last, const Fit& fit) const;
  Peak peak(const Stretch& stretch, std::size_t first, std::size_t last, double cap, double lack) const;
  void solve_below_caps(const Stretch& stretch, std::size_t first, std::size_t last, double cap, double lack);
  void put(double from, double to, const SpeedRamp& ramp, bool capped = false);
  void commit();
  bool give(Phase& phase);

  Lookahead* path_;
  JerkWindow window_;
  std::vector<Part> parts_, before_;
  std::vector<Stretch> open_;
  std::uint64_t planned_end_ = 0;  ///< of the window for which parts_ holds; 0: none
  bool planned_finish_ = false;
  bool no_room_ = false;  ///< a stretch was too short for its speeds
  bool kept_ = false;     ///< what parts_ holds is the plan made when less was known

  // Given out: parts_[0 .. committed_).
  std::size_t committed_ = 0, part_ = 0;
  bool to_the_end_ = false;  ///< what is committed ends the finished path
  int stage_ = 0;
  double stage_s_ = 0;    ///< of the stage, done
  double stage_at_ = 0;   ///< position of its start
  double done_ = 0;       ///< position up to which phases were given
  double speed_ = 0;      ///< at the end of what is committed
  double end_ = 0;        ///< position of that end
  double window_at_ = 0;  ///< position of the start of the first piece that path_ still holds
  std::uint64_t forced_ = 0;
};

}  // namespace kinebus
