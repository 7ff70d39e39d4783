#pragma once
// Deflections of a jog device as jogs that are held: along one axis at a time, slow or fast. What is not
// asked for again ends at the gateway by itself, within 200 ms.

#include <QObject>
#include <QTimer>
#include <optional>

#include "gui/link/hand/jog_device.hpp"
#include "gui/session/session.hpp"

namespace kinebus::gui {

class JogDrive : public QObject {
  Q_OBJECT
 public:
  explicit JogDrive(Session& session, QObject* parent = nullptr);
  /// All it can: mm/s, and as many degrees/s of a turn.
  void set_full_speed(double per_s) { full_per_s_ = per_s; }
  void take(const JogDevice::Deflection& deflection);
  /// Rest, whatever the device says, until it was at rest itself.
  void let_go();
  bool moves() const { return stage_ == Stage::kMoves; }

 private:
  struct Way {
    int axis = 0;
    int sign = 1;
    bool fast = false;
    bool operator==(const Way&) const = default;
  };
  enum class Stage {
    kRest,
    kMoves,
    kEnds,    ///< the gateway is told
    kStills,  ///< and has heard it: until its status says that the machine is ready
  };
  std::optional<Way> way_of(const JogDevice::Deflection& deflection) const;
  void step();
  void ask();
  void end();
  void send(double distance, Session::AnswerHandler then);

  Session& session_;
  QTimer again_;
  Stage stage_ = Stage::kRest;
  std::optional<Way> wanted_;
  Way way_;  ///< in kMoves
  bool until_rest_ = false;
  double full_per_s_ = 50;
};

}  // namespace kinebus::gui
