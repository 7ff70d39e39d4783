#pragma once
// A window of its own for one driver card on a bench: its two motors, their currents, jogged and measured,
// and its switches. No machine file, no gateway.

#include <QCloseEvent>
#include <QComboBox>
#include <QJsonObject>
#include <QLabel>
#include <QPushButton>
#include <QString>
#include <QWidget>
#include <array>

#include "gui/link/bench_card.hpp"
#include "gui/views/number_field.hpp"
#include "gui/views/theme.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class BenchWindow : public SpeakingWidget {
  Q_OBJECT
 public:
  /// `program`: BenchCard::find_program().
  BenchWindow(const Theme& theme, const QString& program, QWidget* parent = nullptr);
  BenchCard& card() { return card_; }

 protected:
  void closeEvent(QCloseEvent* event) override;

 private:
  struct Motor {
    QLabel *heading = nullptr, *drive = nullptr, *place = nullptr, *measured = nullptr;
    NumberField *run = nullptr, *hold = nullptr, *turns = nullptr, *speed = nullptr;
    QPushButton *set = nullptr, *less = nullptr, *more = nullptr, *power = nullptr, *tune = nullptr;
    int told_run_ma = -1, told_hold_ma = -1;  ///< what the fields were filled with
    bool has_power = false;
  };

  QWidget* make_head();
  QWidget* make_motor(int axis);
  void open_or_close();
  void say_buttons();
  void take_state(const QJsonObject& state);
  static QString drive_state(const QString& word);
  void take_motor(int axis, const QJsonObject& state);
  void take_done(const QString& what, const QJsonObject& found);
  void tell(const QString& words);
  void jog(int axis, int sign);
  void send(const QString& verb, int axis, const QString& more = {});

  const Theme& theme_;
  BenchCard card_;
  QComboBox* interface_ = nullptr;
  NumberField* node_ = nullptr;
  QPushButton *open_ = nullptr, *stop_ = nullptr, *store_ = nullptr;
  QLabel *name_ = nullptr, *switches_ = nullptr, *news_ = nullptr;
  std::array<Motor, 2> motors_;
  QJsonObject state_;
};

}  // namespace kinebus::gui
