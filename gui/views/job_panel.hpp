#pragma once
// The job at work: how far, how long, and the buttons for it. Visible on every page.

#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSlider>
#include <QWidget>

#include "gui/views/desk.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class JobPanel : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit JobPanel(Desk& desk, QWidget* parent = nullptr);

 private:
  void take_status();
  void choose_object();

  Desk& desk_;
  ElidedLabel* name_;
  QLabel* doing_;
  QProgressBar* progress_;
  QLabel *percent_, *elapsed_, *remaining_, *line_, *override_text_;
  QSlider* override_;
  QPushButton *pause_, *resume_, *cancel_, *objects_;
};

}  // namespace kinebus::gui
