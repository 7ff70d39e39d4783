#pragma once
// Where the tool really went in the last minutes, relative to the part: by the axes' encoders where there are
// any, else as the gateway commanded it.

#include <QObject>
#include <QVector3D>
#include <deque>
#include <memory>
#include <vector>

namespace kinebus::gui {

class Session;

class Trail : public QObject {
  Q_OBJECT
 public:
  static constexpr double kKept_s = 300;

  explicit Trail(Session& session, QObject* parent = nullptr);
  /// Ends of lines, two and two, mm.
  std::shared_ptr<const std::vector<QVector3D>> lines() const;
  bool measured() const { return measured_; }
  /// Of the measured place from the commanded one, in what is kept, mm.
  double farthest_off_mm() const;

 private:
  struct Point {
    double time_s = 0;
    QVector3D place_mm;
    float off_mm = 0;
    bool first = false;  ///< nobody knows how it came here
  };

  std::deque<Point> points_;
  bool measured_ = false, broken_ = true;
  mutable std::shared_ptr<const std::vector<QVector3D>> lines_;  ///< of the points; nullptr: to be made
};

}  // namespace kinebus::gui
