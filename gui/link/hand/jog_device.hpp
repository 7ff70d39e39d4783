#pragma once
// A thing in the user's hand that moves the machine as long as it is deflected: gamepad, 3D mouse.

#include <QObject>
#include <QString>
#include <array>
#include <memory>
#include <vector>

namespace kinebus::gui {

class JogDevice : public QObject {
  Q_OBJECT
 public:
  enum Axis { kX, kY, kZ, kA, kC, kE, kAxes };
  /// Share of all it can, -1..1 along each axis; 0: at rest. A dead-man's key that is not held is rest.
  using Deflection = std::array<float, kAxes>;

  using QObject::QObject;
  /// What it calls itself; empty: none is here.
  virtual QString name() const = 0;
  /// Has a key that must be held for it to move anything.
  virtual bool has_dead_man() const = 0;
  /// It is looked for, and read, while somebody wants it.
  virtual void listen(bool wanted) = 0;

 signals:
  /// Of the one that went, rest comes first.
  void name_changed();
  void deflected(const kinebus::gui::JogDevice::Deflection& deflection);
};

/// All kinds that this build knows.
std::vector<std::unique_ptr<JogDevice>> make_jog_devices();

}  // namespace kinebus::gui
