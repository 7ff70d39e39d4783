#pragma once
// The machine from inside: axes and nodes as they are now, plots, and the machine file.

#include <QLabel>
#include <QTabWidget>
#include <QTableView>
#include <QVector>
#include <QWidget>

#include "gui/views/desk.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class HeatPanel;
class MachineFileEditor;

class MachinePage : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit MachinePage(Desk& desk, QWidget* parent = nullptr);
  void show_tab(int index) { tabs_->setCurrentIndex(index); }
  MachineFileEditor& editor() { return *editor_; }
  HeatPanel& heat_panel() { return *heat_; }

 private:
  QWidget* make_live();
  QWidget* make_numbers();
  void take_status();

  Desk& desk_;
  QTableView* axes_ = nullptr;
  QTabWidget* tabs_;
  MachineFileEditor* editor_;
  HeatPanel* heat_;
  QLabel* summary_;
  QVector<std::pair<QLabel*, std::function<QString()>>> numbers_;
};

}  // namespace kinebus::gui
