#pragma once
// The keys of moving by hand, on the screen and on the keyboard: a click is a step, a key that is held moves
// until it is let go. And gamepad and 3D mouse, once they are switched on here, while the page is in front.

#include <QButtonGroup>
#include <QCheckBox>
#include <QEvent>
#include <QKeyEvent>
#include <QLabel>
#include <QPushButton>
#include <QTimer>
#include <QVector>
#include <QWidget>
#include <memory>
#include <optional>
#include <vector>

#include "gui/link/hand/jog_device.hpp"
#include "gui/session/jog_drive.hpp"
#include "gui/views/desk.hpp"
#include "gui/views/number_field.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class JogPad : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit JogPad(Desk& desk, QWidget* parent = nullptr);

  /// What a key means here. False: nothing.
  bool key(const QKeyEvent& event);
  /// Whatever is held is let go: the keyboard or the window is somebody else's now.
  void let_go();
  /// One more thing in the user's hand.
  void follow(std::unique_ptr<JogDevice> device);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  enum class Axis { kX, kY, kZ, kA, kC, kE };
  struct Way {
    Axis axis;
    int sign;
    bool operator==(const Way&) const = default;
  };
  QWidget* make_keys(QWidget* parent);
  QWidget* make_steps();
  QPushButton* jog_button(Way way, const QString& icon);
  static std::optional<Way> way_of(int key);
  void press(Way way);
  void release(Way way);
  void keep_moving();
  void send(Way way, double distance, bool held);
  void take_status();
  void take_machine();
  void tell_devices();
  void take_deflection(const JogDevice& device, const JogDevice::Deflection& deflection);

  Desk& desk_;
  QButtonGroup* steps_;
  NumberField* speed_;
  QVector<QPushButton*> jog_buttons_, turn_buttons_;
  QLabel* hint_;
  std::optional<Way> pressed_;
  bool moving_ = false;  ///< what is pressed has been held long enough
  QTimer long_enough_, again_;
  QCheckBox* by_hand_;  ///< gamepad and 3D mouse move the machine
  QLabel* by_hand_hint_;
  JogDrive drive_;
  std::vector<std::unique_ptr<JogDevice>> devices_;
};

}  // namespace kinebus::gui
