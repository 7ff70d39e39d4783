#include "gui/views/filament_keys.hpp"

#include <QHBoxLayout>
#include <QPushButton>

#include "gui/models/format.hpp"

namespace kinebus::gui {
namespace {
using joblink::MoveFilament;
constexpr std::array<MoveFilament::What, 3> kWays{MoveFilament::UNLOAD, MoveFilament::LOAD,
                                                  MoveFilament::PURGE};
}  // namespace

FilamentKeys::FilamentKeys(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(6);
  for (std::size_t i = 0; i < kWays.size(); ++i) {
    keys_[i] = make_button(desk_.theme, {}, "", this);
    row->addWidget(keys_[i], 1);
    connect(keys_[i], &QPushButton::clicked, this, [this, i] { desk_.session.move_filament(kWays[i]); });
  }
  connect(&desk_.session, &Session::status_changed, this, &FilamentKeys::take_status);
  connect(&desk_.session, &Session::link_changed, this, &FilamentKeys::take_status);
  connect(&desk_.session, &Session::machine_changed, this, &FilamentKeys::take_status);
  says([this] {
    keys_[0]->setText(tr("Unload"));
    keys_[1]->setText(tr("Load"));
    keys_[2]->setText(tr("Purge"));
    take_status();
  });
}

void FilamentKeys::take_status() {
  const joblink::FilamentWays& ways = desk_.session.machine().filament_ways();
  const std::array<double, 3> mm{ways.unload_mm(), ways.load_mm(), ways.purge_mm()};
  const bool can = desk_.session.allowed(joblink::COMMAND_MOVE_FILAMENT);
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    keys_[i]->setToolTip(tr("%1 mm of filament").arg(Format::number(mm[i], 0)));
    set_usable(*keys_[i], can && mm[i] > 0,
               mm[i] > 0 ? desk_.session.why_not(joblink::COMMAND_MOVE_FILAMENT)
                         : tr("[pause] of the machine file says no length"));
  }
}

}  // namespace kinebus::gui
