#pragma once
// What the job under way, or the last one, has taken: time, filament, and its worst figures; and how it
// ended. As far as this program was there to see it.

#include <QObject>
#include <QVector>
#include <string>

#include "gui/models/problems_model.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

class Session;

class JobRecord : public QObject {
  Q_OBJECT
 public:
  enum class End { kNone, kComplete, kCancelled, kStopped, kRefused };
  struct Figures {
    double elapsed_s = 0;
    double filament_mm = 0;
    double clock_error_us = 0;  ///< largest
    double bus_load = 0;        ///< largest
    double emptiest_queue = 1;  ///< share of a node's room, in the midst of motion; 1: not seen
    std::uint32_t stalls = 0;   ///< holds for planning, slowed for the bus, underruns
  };

  explicit JobRecord(Session& session, QObject* parent = nullptr);
  const std::string& name() const { return name_; }  ///< empty: none yet
  End end() const { return end_; }
  const Figures& figures() const { return figures_; }
  /// What kept it from beginning, or was remarked when it began.
  const QVector<ShownProblem>& problems() const { return problems_; }

 signals:
  void checked();  ///< it begins, whatever problems() remark
  void ended();

 private:
  void take(const joblink::Status& status);
  void begin(const joblink::Status& status);
  void finish(End end);

  std::string name_;
  End end_ = End::kNone;
  Figures figures_;
  QVector<ShownProblem> problems_, found_;
  joblink::State before_ = joblink::STATE_OFF;
  bool under_way_ = false, streamed_ = false;
  std::uint32_t stalls_before_ = 0;
};

}  // namespace kinebus::gui
