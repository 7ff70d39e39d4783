#pragma once
// The driver cards: what each motor gets and has, and what may be set and tried of one of them.

#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QTableView>
#include <QWidget>

#include "gui/views/desk.hpp"
#include "gui/views/number_field.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class MotorsPanel : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit MotorsPanel(Desk& desk, QWidget* parent = nullptr);

 private:
  QWidget* make_table();
  QWidget* make_currents();
  QWidget* make_trial();
  void take_machine();
  void take_status();
  void take_motor();
  void jog(int sign);
  /// nullptr: there is no machine.
  const joblink::Joint* joint() const;
  const joblink::AxisStatus* axis() const;

  Desk& desk_;
  QTableView* table_ = nullptr;
  QComboBox* motor_ = nullptr;
  NumberField *run_ = nullptr, *hold_ = nullptr, *step_ = nullptr;
  QPushButton *set_ = nullptr, *less_ = nullptr, *more_ = nullptr, *tune_ = nullptr;
  double told_run_a_ = 0, told_hold_a_ = 0;  ///< what the fields were filled with
  QLabel *inputs_ = nullptr, *bench_ = nullptr;
};

}  // namespace kinebus::gui
