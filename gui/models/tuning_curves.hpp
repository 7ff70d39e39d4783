#pragma once
// How heaters were measured by their nodes, as far as it was seen from here: the curve of each one's last
// measurement.

#include <QObject>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

class Session;

struct TuningCurve {
  struct Point {
    double time_s = 0;  ///< since it began
    double celsius = 0;
  };
  std::vector<Point> points;  ///< ascending
  double target_celsius = 0;
  double power_off_s = -1;  ///< < 0: not yet
  joblink::TuningStage stage = joblink::TUNING_NONE;
  double began_s = 0;      ///< the gateway's clock
  double period_s = 0.25;  ///< from point to point
};

/// The gateway's stage is one of a measurement at work.
bool measures(joblink::TuningStage stage);
/// 0 .. 1: full power takes it half of the way, and about as long is its curve followed without.
double progress_of(const TuningCurve& curve);

class TuningCurves : public QObject {
  Q_OBJECT
 public:
  explicit TuningCurves(Session& session, QObject* parent = nullptr);
  /// Of the heater of that name; nullptr: none was seen.
  const TuningCurve* of(const std::string& heater) const;

 signals:
  void changed();

 private:
  void take(const joblink::Status& status);
  /// A curve that has more is thinned by half.
  static constexpr std::size_t kMostPoints = 4000;

  std::map<std::string, TuningCurve> curves_;
  double time_s_ = 0;
};

}  // namespace kinebus::gui
