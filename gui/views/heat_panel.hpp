#pragma once
// A heater measured by its node: which one and for what temperature, how far it is, its curve, what was found
// and where that is kept.

#include <QComboBox>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QString>
#include <QVector>
#include <QWidget>
#include <functional>

#include "gui/views/desk.hpp"
#include "gui/views/number_field.hpp"
#include "gui/views/tuning_plot.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class HeatPanel : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit HeatPanel(Desk& desk, QWidget* parent = nullptr);
  /// By its name in the machine file.
  void choose(const QString& heater) { heater_->setCurrentText(heater); }

 private:
  QWidget* make_choice();
  QWidget* make_curve();
  QWidget* make_result();
  const joblink::HeaterInfo* chosen() const;
  const joblink::Heater* heater() const;    ///< the chosen one's status
  const joblink::Heater* measured() const;  ///< the one that is measured now, whichever is chosen
  void take_machine();
  void take_heater();
  void take_status();
  void tell_stage(const joblink::Heater* heater);
  void ask_to_measure();
  void give_up();

  Desk& desk_;
  QComboBox* heater_ = nullptr;
  NumberField* target_ = nullptr;
  QPushButton *measure_ = nullptr, *give_up_ = nullptr;
  QLabel *actual_ = nullptr, *stage_ = nullptr, *kept_ = nullptr;
  QProgressBar* progress_ = nullptr;
  TuningPlot* plot_ = nullptr;
  struct Fact {
    QLabel* value;
    std::function<QString(const joblink::HeaterTuning&)> words;
  };
  QVector<Fact> facts_;
};

}  // namespace kinebus::gui
