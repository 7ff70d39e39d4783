#pragma once
// The first page: gateways that are there now, and the demo machine.

#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <QVector>
#include <QWidget>

#include "gui/views/bench_window.hpp"
#include "gui/views/desk.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class ConnectPage : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit ConnectPage(Desk& desk, QWidget* parent = nullptr);
  void start_demo();
  BenchWindow& show_bench();

 private:
  void rebuild();
  void tell();

  Desk& desk_;
  QVBoxLayout* found_;
  QLabel *title_, *subtitle_, *found_heading_, *none_, *demo_heading_, *demo_words_, *bench_heading_,
      *bench_words_, *problem_, *link_words_;
  QPushButton *demo_, *bench_, *leave_;
  Card* link_card_;
  BenchWindow* bench_window_ = nullptr;
  QVector<QWidget*> rows_;
};

}  // namespace kinebus::gui
