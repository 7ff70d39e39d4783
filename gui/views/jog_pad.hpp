#pragma once
// The keys of moving by hand, on the screen and on the keyboard: a click is a step, a key that is held moves
// until it is let go.

#include <QButtonGroup>
#include <QEvent>
#include <QKeyEvent>
#include <QLabel>
#include <QPushButton>
#include <QTimer>
#include <QVector>
#include <QWidget>
#include <optional>

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

  Desk& desk_;
  QButtonGroup* steps_;
  NumberField* speed_;
  QVector<QPushButton*> jog_buttons_, turn_buttons_;
  QLabel* hint_;
  std::optional<Way> pressed_;
  bool moving_ = false;  ///< what is pressed has been held long enough
  QTimer long_enough_, again_;
};

}  // namespace kinebus::gui
