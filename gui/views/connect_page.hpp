#pragma once
// The first page: gateways that are there now, and the demo machine.

#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <QVector>
#include <QWidget>

#include "gui/views/desk.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class ConnectPage : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit ConnectPage(Desk& desk, QWidget* parent = nullptr);
  void start_demo();

 private:
  void rebuild();
  void tell();

  Desk& desk_;
  QVBoxLayout* found_;
  QLabel *title_, *subtitle_, *found_heading_, *none_, *demo_heading_, *demo_words_, *problem_, *link_words_;
  QPushButton *demo_, *leave_;
  Card* link_card_;
  QVector<QWidget*> rows_;
};

}  // namespace kinebus::gui
