#pragma once
// A gamepad, by SDL: left stick X and Y, right stick Z and C, and only while the left shoulder key is held.

#include <QString>
#include <QTimer>

#include "gui/link/hand/jog_device.hpp"

struct _SDL_GameController;  // NOLINT(bugprone-reserved-identifier): SDL's own name

namespace kinebus::gui {

class Gamepad : public JogDevice {
  Q_OBJECT
 public:
  explicit Gamepad(QObject* parent = nullptr);
  ~Gamepad() override;
  QString name() const override { return name_; }
  bool has_dead_man() const override { return true; }
  void listen(bool wanted) override;

 private:
  void look();
  void open(int index);
  void close();

  _SDL_GameController* pad_ = nullptr;
  QString name_;
  QTimer poll_;
  bool begun_ = false;
  Deflection last_{};
};

}  // namespace kinebus::gui
