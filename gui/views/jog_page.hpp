#pragma once
// Moving the tool by hand: the jog keys, homing, the bed reference, motors, work offsets.

#include <QComboBox>
#include <QEvent>
#include <QFocusEvent>
#include <QGridLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPushButton>
#include <QResizeEvent>
#include <QVector>
#include <QWidget>

#include "gui/views/desk.hpp"
#include "gui/views/jog_pad.hpp"
#include "gui/views/number_field.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class JogPage : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit JogPage(Desk& desk, QWidget* parent = nullptr);

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  QWidget* make_actions();
  QWidget* make_pin(QWidget* parent);
  QWidget* make_offsets();
  void take_status();
  void show_pin();
  void arrange();

  enum class Shape { kNone, kBeside, kBelow };
  Desk& desk_;
  QGridLayout* grid_;
  Shape shape_ = Shape::kNone;
  JogPad* pad_;
  QWidget *actions_ = nullptr, *offsets_ = nullptr;
  QPushButton *home_, *reference_, *motors_off_, *clear_, *hold_;
  QWidget* pin_ = nullptr;
  QLabel* pin_state_ = nullptr;
  QVector<QPushButton*> pin_buttons_;
  QComboBox* system_;
  QVector<NumberField*> offset_boxes_;
  QPushButton *zero_here_, *set_offset_;
  QLabel* active_offset_;
};

}  // namespace kinebus::gui
