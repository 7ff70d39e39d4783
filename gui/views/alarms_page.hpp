#pragma once
// Alarms and what to do next, and what else has happened where that is asked for. The newest open alarm
// stands on top, large.

#include <QCheckBox>
#include <QLabel>
#include <QListView>
#include <QPushButton>
#include <QSortFilterProxyModel>
#include <QWidget>

#include "gui/views/desk.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class AlarmsPage : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit AlarmsPage(Desk& desk, QWidget* parent = nullptr);

 private:
  void take();

  Desk& desk_;
  Card* open_;
  QLabel *title_, *details_, *advice_, *fine_;
  QPushButton* clear_;
  QCheckBox* everything_;
  QSortFilterProxyModel* shown_;
  QListView* list_;
};

}  // namespace kinebus::gui
