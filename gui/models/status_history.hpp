#pragma once
// The last two minutes of what is plotted: bus load, sync error, queue, path rate.

#include <QObject>
#include <array>
#include <deque>

namespace kinebus::gui {

class Session;

class StatusHistory : public QObject {
  Q_OBJECT
 public:
  enum Series { kBusLoad, kSyncError_us, kQueue, kRate, kSeries };
  struct Sample {
    double time_s = 0;
    std::array<float, kSeries> values{};
  };
  static constexpr double kKept_s = 120;

  explicit StatusHistory(Session& session, QObject* parent = nullptr);
  const std::deque<Sample>& samples() const { return samples_; }

 signals:
  void changed();

 private:
  static constexpr double kPeriod_s = 0.2;
  std::deque<Sample> samples_;
};

}  // namespace kinebus::gui
