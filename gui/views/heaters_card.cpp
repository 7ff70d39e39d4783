#include "gui/views/heaters_card.hpp"

#include <QGridLayout>
#include <QMenu>
#include <QStringList>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "gui/models/format.hpp"

namespace kinebus::gui {
namespace {

QGridLayout* make_grid(Card& card) {
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(10);
  grid->setVerticalSpacing(5);
  grid->setColumnStretch(1, 1);
  card.column()->addLayout(grid);
  return grid;
}

/// As jobs number them: T0 is the first.
QString code_of(std::uint32_t hotend) {
  return Format::isolated(QStringLiteral("T%1").arg(hotend));
}

void drop(QWidget* widget) {
  widget->hide();  // at once: it goes when the event loop has its turn
  widget->deleteLater();
}

}  // namespace

HeatersCard::HeatersCard(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  auto* card = new Card(this);
  column->addWidget(card);
  card->column()->setContentsMargins(16, 10, 16, 11);
  auto* heading = make_label("heading", card);
  card->column()->addWidget(heading);
  heaters_grid_ = make_grid(*card);
  fans_grid_ = make_grid(*card);
  materials_ = new QToolButton(card);
  materials_->setPopupMode(QToolButton::InstantPopup);
  materials_->setToolButtonStyle(Qt::ToolButtonTextOnly);
  materials_->setMenu(new QMenu(materials_));
  card->column()->addWidget(materials_);
  connect(&desk_.session, &Session::machine_changed, this, &HeatersCard::take_machine);
  connect(&desk_.session, &Session::status_changed, this, &HeatersCard::take_status);
  connect(&desk_.session, &Session::link_changed, this, &HeatersCard::take_status);
  says([this, heading] {
    heading->setText(tr("Heat"));
    materials_->setText(tr("Heat for a material"));
    materials_->setToolTip(tr("Temperatures by the machine file: tables [material.NAME]"));
    take_machine();
  });
}

void HeatersCard::take_machine() {
  const auto& told = desk_.session.machine().heaters();
  const bool same = std::equal(heaters_.begin(), heaters_.end(), told.begin(), told.end(),
                               [](const HeaterRow& row, const joblink::HeaterInfo& info) {
                                 return row.kind == info.kind() && row.index == info.index();
                               });
  if (!same) {
    for (const HeaterRow& row : heaters_)
      for (QWidget* each : {static_cast<QWidget*>(row.name), static_cast<QWidget*>(row.actual),
                            static_cast<QWidget*>(row.target)})
        drop(each);
    heaters_.clear();
    for (const joblink::HeaterInfo& info : told) add_heater(info);
  }
  for (int i = 0; i < told.size(); ++i) {
    static constexpr double kUsualMost = 300;  // of a machine file that says none
    const double most = told[i].max_celsius();
    heaters_[static_cast<std::size_t>(i)].target->setRange(0, most > 0 ? most : kUsualMost);
  }
  take_materials();
  say_rows();
  take_status();
}

void HeatersCard::add_heater(const joblink::HeaterInfo& info) {
  QWidget* card = materials_->parentWidget();
  const HeaterRow row{info.kind(), info.index(), new QLabel(card), new QLabel(card), new NumberField(card)};
  row.target->setDecimals(0);
  row.target->setSingleStep(5);
  row.target->setSuffix(QStringLiteral(" °C"));
  row.target->setAlignment(Qt::AlignRight);
  row.target->setFixedWidth(84);
  const int at = static_cast<int>(heaters_.size());
  heaters_grid_->addWidget(row.name, at, 0);
  heaters_grid_->addWidget(row.actual, at, 1, Qt::AlignTrailing);
  heaters_grid_->addWidget(row.target, at, 2);
  connect(row.target, &NumberField::refused, &desk_.session, &Session::refused);
  connect(row.target, &NumberField::editingFinished, this, [this, row] { set_target(row); });
  QWidget* before = at > 0 ? heaters_.back().target : nullptr;
  if (before != nullptr) setTabOrder(before, row.target);
  heaters_.push_back(row);
}

void HeatersCard::set_target(const HeaterRow& row) {
  const joblink::Heater* heater = known(row);
  static constexpr double kSame = 0.5;  // the field has whole degrees
  if (heater != nullptr && desk_.session.connected() &&
      std::abs(row.target->value() - heater->target_celsius()) > kSame)
    desk_.session.set_heater(row.kind, row.index, row.target->value());
}

bool HeatersCard::several(joblink::HeaterKind kind) const {
  return std::count_if(heaters_.begin(), heaters_.end(),
                       [kind](const HeaterRow& row) { return row.kind == kind; }) > 1;
}

QString HeatersCard::heater_name(const HeaterRow& row) const {
  switch (row.kind) {
    case joblink::HEATER_BED:
      return tr("Bed");
    case joblink::HEATER_CHAMBER:
      return tr("Chamber");
    default:
      return several(row.kind) ? tr("Nozzle %1").arg(code_of(row.index)) : tr("Nozzle");
  }
}

QString HeatersCard::target_name(const HeaterRow& row) const {
  switch (row.kind) {
    case joblink::HEATER_BED:
      return tr("Target temperature of the bed");
    case joblink::HEATER_CHAMBER:
      return tr("Target temperature of the chamber");
    default:
      return several(row.kind) ? tr("Target temperature of nozzle %1").arg(code_of(row.index))
                               : tr("Target temperature of the nozzle");
  }
}

const joblink::Heater* HeatersCard::known(const HeaterRow& row) const {
  for (const joblink::Heater& each : desk_.session.status().heaters())
    if (each.kind() == row.kind && each.index() == row.index) return &each;
  return nullptr;
}

void HeatersCard::say_rows() {
  for (const HeaterRow& row : heaters_) {
    row.name->setText(heater_name(row));
    row.target->setAccessibleName(target_name(row));
    row.target->setSpecialValueText(tr("off"));
  }
}

void HeatersCard::take_status() {
  const bool connected = desk_.session.connected();
  for (const HeaterRow& row : heaters_) {
    const joblink::Heater* heater = known(row);
    row.actual->setText(connected && heater != nullptr
                            ? Format::isolated(Format::temperature(heater->actual_celsius()))
                            : QStringLiteral("—"));
    // Set only when it is another: a spin box paints itself, and with it the whole window, even for the same.
    if (heater != nullptr && !row.target->hasFocus() && row.target->value() != heater->target_celsius())
      row.target->setValue(heater->target_celsius());
    row.target->setEnabled(connected && heater != nullptr);
    if (row.kind != joblink::HEATER_HOTEND || !several(row.kind)) continue;
    const bool in_use = connected && desk_.session.status().hotend_in_use() == row.index;
    row.name->setText(in_use ? tr("%1, in use").arg(heater_name(row)) : heater_name(row));
  }
  take_fans();
  materials_->setEnabled(connected && desk_.session.allowed(joblink::COMMAND_SET_TEMPERATURE));
}

void HeatersCard::have_fans(std::size_t count) {
  QWidget* card = materials_->parentWidget();
  while (fans_.size() > count) {
    drop(fans_.back().name);
    drop(fans_.back().share);
    fans_.pop_back();
  }
  while (fans_.size() < count) {
    const FanRow row{new QLabel(card), new QLabel(card)};
    fans_grid_->addWidget(row.name, static_cast<int>(fans_.size()), 0);
    fans_grid_->addWidget(row.share, static_cast<int>(fans_.size()), 2, Qt::AlignTrailing);
    fans_.push_back(row);
  }
}

/// Several have the names of the machine file.
void HeatersCard::take_fans() {
  const auto& told = desk_.session.status().fans();
  const bool many = told.size() > 1;
  have_fans(many ? static_cast<std::size_t>(told.size()) : 1);
  for (std::size_t i = 0; i < fans_.size(); ++i) {
    const auto at = static_cast<int>(i);
    fans_[i].name->setText(many ? tr("Fan %1").arg(Format::isolated(QString::fromStdString(told[at].name())))
                                : tr("Fan"));
    const double share = many ? told[at].ratio() : desk_.session.status().fan();
    fans_[i].share->setText(desk_.session.connected() ? Format::percent(share) : QStringLiteral("—"));
  }
}

void HeatersCard::take_materials() {
  const auto& all = desk_.session.machine().materials();
  QMenu* menu = materials_->menu();
  menu->clear();
  for (const joblink::Material& each : all) {
    QStringList degrees;
    for (const double celsius : {each.hotend_celsius(), each.bed_celsius(), each.chamber_celsius()})
      if (celsius > 0) degrees << Format::isolated(Format::temperature(celsius));
    menu->addAction(
        QString::fromStdString(each.name()) + QStringLiteral("   ") + degrees.join(QStringLiteral(" / ")),
        this, [this, each] { heat_for(each); });
  }
  menu->addAction(tr("off"), this, [this] {
    for (const auto& heater : desk_.session.machine().heaters())
      desk_.session.set_heater(heater.kind(), heater.index(), 0);
  });
  materials_->setVisible(!all.empty());
}

/// Of several hot ends the one in use: others are for other filament.
void HeatersCard::heat_for(const joblink::Material& material) {
  const auto heat = [&](joblink::HeaterKind kind, std::uint32_t index, double celsius) {
    if (celsius > 0) desk_.session.set_heater(kind, index, celsius);
  };
  heat(joblink::HEATER_BED, 0, material.bed_celsius());
  heat(joblink::HEATER_CHAMBER, 0, material.chamber_celsius());
  heat(joblink::HEATER_HOTEND, desk_.session.status().hotend_in_use(), material.hotend_celsius());
}

}  // namespace kinebus::gui
