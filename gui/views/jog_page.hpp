#pragma once
// Moving the tool by hand: buttons and keys in steps, homing, the bed reference, motors, work offsets.

#include <QButtonGroup>
#include <QComboBox>
#include <QEvent>
#include <QKeyEvent>
#include <QLabel>
#include <QPushButton>
#include <QVector>
#include <QWidget>

#include "gui/views/desk.hpp"
#include "gui/views/number_field.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class JogPage : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit JogPage(Desk& desk, QWidget* parent = nullptr);

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  enum class Axis { kX, kY, kZ, kA, kC, kE };
  QWidget* make_pad();
  QWidget* make_steps();
  QWidget* make_actions();
  QWidget* make_offsets();
  QPushButton* jog_button(Axis axis, int sign, const QString& icon);
  void jog(Axis axis, int sign);
  void take_status();
  void take_machine();

  Desk& desk_;
  QButtonGroup* steps_;
  NumberField* speed_;
  QVector<QPushButton*> jog_buttons_, turn_buttons_;
  QPushButton *home_, *reference_, *motors_off_, *clear_, *hold_;
  QComboBox* system_;
  QVector<NumberField*> offset_boxes_;
  QPushButton *zero_here_, *set_offset_;
  QLabel *hint_, *active_offset_;
};

}  // namespace kinebus::gui
