#pragma once
// The job at work: how far, how long, and the buttons for it; when it has ended, what it has taken. Visible
// on every page.

#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSlider>
#include <QStackedLayout>
#include <QWidget>
#include <array>

#include "gui/views/desk.hpp"
#include "gui/views/filament_keys.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class JobPanel : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit JobPanel(Desk& desk, QWidget* parent = nullptr);

 private:
  void take_status();
  void choose_object();
  struct Fact {
    QString name, value;
  };
  /// Of the job; of the one that has ended, its report.
  std::array<Fact, 6> facts(bool job, bool report) const;
  QString doing(bool job, bool report, bool lost) const;

  Desk& desk_;
  ElidedLabel* name_;
  QLabel* doing_;
  QProgressBar* progress_;
  struct FactLabels {
    QLabel *name, *value;
  };
  std::array<FactLabels, 6> facts_;
  QWidget* speed_row_;
  QLabel* override_text_;
  QSlider* override_;
  QPushButton *pause_, *resume_, *cancel_, *aside_, *objects_;
  QStackedLayout *pause_or_resume_, *aside_or_filament_;
  FilamentKeys* filament_;
};

}  // namespace kinebus::gui
