#pragma once
// What heaters and fans did: the last ten minutes, second by second, and the whole of the job that was begun
// last, as finely as fits. Bounded, however long a job takes.

#include <QObject>
#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

class Session;

class HeatHistory : public QObject {
  Q_OBJECT
 public:
  enum class Span { kRecent, kJob };
  struct Heat {
    float celsius = 0, target = 0;
    float power = -1;  ///< of full; < 0: not told
  };
  struct Sample {
    double time_s = 0;  ///< the gateway's clock
    std::vector<Heat> heaters;
    std::vector<float> fans;  ///< 0..1
  };
  static constexpr double kRecent_s = 600;
  /// A job's samples beyond this are thinned by half.
  static constexpr std::size_t kMostOfJob = 2400;

  /// Takes what the session is told.
  explicit HeatHistory(Session& session, QObject* parent = nullptr);
  void take(const joblink::Status& status);
  /// As the gateway has kept it: takes the place of what is older than its last sample.
  void take(const joblink::HeatCourse& course);
  /// Ascending in time.
  const std::deque<Sample>& samples(Span span) const { return span == Span::kJob ? job_ : recent_; }
  /// In the order of a sample's values.
  const std::vector<std::string>& heaters() const { return heaters_; }
  const std::vector<std::string>& fans() const { return fans_; }

 signals:
  void changed();

 private:
  static constexpr double kPeriod_s = 1;
  void take_job(const joblink::Status& status, const Sample& sample);
  void begin_anew(std::vector<std::string> heaters, std::vector<std::string> fans);
  std::deque<Sample> samples_of(const joblink::HeatSamples& told) const;
  void thin_job();

  std::vector<std::string> heaters_, fans_;
  std::deque<Sample> recent_, job_;
  double job_period_s_ = kPeriod_s;
  double elapsed_s_ = 0;  ///< of the job, as told last
  std::string job_name_;
};

}  // namespace kinebus::gui
