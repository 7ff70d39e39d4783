#pragma once
// Unload, load and purge: three buttons in a row, for machines that feed filament.

#include <QPushButton>
#include <QWidget>
#include <array>

#include "gui/views/desk.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class FilamentKeys : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit FilamentKeys(Desk& desk, QWidget* parent = nullptr);
  /// The machine has something to feed filament with.
  bool is_of_use() const { return desk_.session.machine().has_filament_ways(); }

 private:
  void take_status();

  Desk& desk_;
  std::array<QPushButton*, 3> keys_;  ///< in the order of joblink::MoveFilament
};

}  // namespace kinebus::gui
