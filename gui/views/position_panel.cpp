#include "gui/views/position_panel.hpp"

#include <QColor>
#include <QFont>
#include <QGridLayout>
#include <QLabel>
#include <QPaintEvent>
#include <QPainter>
#include <QPalette>
#include <QRectF>
#include <QVBoxLayout>
#include <QWidget>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gui/models/format.hpp"
#include "gui/views/heaters_card.hpp"

namespace kinebus::gui {
namespace {
constexpr double kDegPerRad = 180 / std::numbers::pi;

QFont digits_font(const QFont& base, double points, bool bold) {
  QFont font = base;
  font.setFamilies(
      {QStringLiteral("DejaVu Sans Mono"), QStringLiteral("Noto Sans Mono"), QStringLiteral("monospace")});
  font.setPointSizeF(points);
  font.setBold(bold);
  return font;
}
}  // namespace

TravelBar::TravelBar(QWidget* parent) : QWidget(parent) {
  setFixedHeight(12);
  setMinimumWidth(50);
}

void TravelBar::set(double share, const QColor& colour) {
  if (share_ == share && colour_ == colour) return;
  share_ = share;
  colour_ = colour;
  update();
}

void TravelBar::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF groove(0, height() / 2.0 - 2, width(), 4);
  painter.setPen(Qt::NoPen);
  painter.setBrush(palette().color(QPalette::Mid));
  painter.drawRoundedRect(groove, 2, 2);
  if (share_ < 0) return;
  const double at = std::clamp(share_, 0.0, 1.0) * (width() - 8);
  painter.setBrush(colour_);
  painter.drawRoundedRect(QRectF(at, height() / 2.0 - 6, 8, 12), 3, 3);
}

PositionPanel::PositionPanel(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(6, 2, 12, 6);
  column->setSpacing(8);
  column->addWidget(make_axes());
  column->addWidget(new HeatersCard(desk_, this));
  joints_card_ = new Card(this);
  joints_card_->column()->setContentsMargins(16, 10, 16, 11);
  joints_heading_ = make_label("heading", this);
  joints_card_->column()->addWidget(joints_heading_);
  joints_grid_ = new QGridLayout;
  joints_grid_->setHorizontalSpacing(10);
  joints_grid_->setVerticalSpacing(3);
  joints_grid_->setColumnStretch(1, 1);
  joints_card_->column()->addLayout(joints_grid_);
  column->addWidget(joints_card_);
  column->addStretch(1);
  setMinimumWidth(268);
  connect(&desk_.session, &Session::machine_changed, this, &PositionPanel::rebuild_joints);
  connect(&desk_.session, &Session::status_changed, this, &PositionPanel::take_status);
  connect(&desk_.session, &Session::link_changed, this, &PositionPanel::take_status);
  connect(&desk_.theme, &Theme::changed, this, &PositionPanel::take_status);
  rebuild_joints();
  says([this] {
    joints_heading_->setText(tr("Carriages and axes"));
    take_status();
  });
}

QWidget* PositionPanel::make_axes() {
  auto* card = new Card(this);
  card->column()->setContentsMargins(16, 10, 16, 11);
  frame_text_ = make_label("small", card);
  card->column()->addWidget(frame_text_);
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(9);
  grid->setVerticalSpacing(0);
  grid->setColumnStretch(1, 1);
  static constexpr std::array<const char*, 6> kNames{"X", "Y", "Z", "A", "C", "E"};
  for (int i = 0; i < 6; ++i) {
    AxisRow row{make_label("heading", card), new QLabel(card), make_label("small", card)};
    row.name->setText(QString::fromLatin1(kNames[static_cast<std::size_t>(i)]));
    row.value->setFont(digits_font(font(), i < 3 ? 16 : 11, i < 3));
    row.value->setStyleSheet(
        QStringLiteral(
            "font-family: 'DejaVu Sans Mono', 'Noto Sans Mono', monospace; font-size: %1pt; font-weight: %2;")
            .arg(i < 3 ? 16 : 11)
            .arg(i < 3 ? 600 : 400));
    row.value->setAlignment(Qt::AlignRight | Qt::AlignAbsolute | Qt::AlignVCenter);
    row.unit->setText(i == 3 || i == 4 ? QStringLiteral("°") : QStringLiteral("mm"));
    row.unit->setMinimumWidth(22);
    grid->addWidget(row.name, i, 0);
    grid->addWidget(row.value, i, 1);
    grid->addWidget(row.unit, i, 2);
    axes_.push_back(row);
  }
  card->column()->addLayout(grid);
  return card;
}

void PositionPanel::rebuild_joints() {
  for (const JointRow& row : joints_)
    for (QWidget* w : {static_cast<QWidget*>(row.name), static_cast<QWidget*>(row.value),
                       static_cast<QWidget*>(row.bar), static_cast<QWidget*>(row.by_scale)}) {
      if (w == nullptr) continue;
      w->hide();  // at once: it goes when the event loop has its turn
      w->deleteLater();
    }
  joints_.clear();
  const auto& machine = desk_.session.machine();
  int i = 0, number = -1;
  for (const auto& joint : machine.joints()) {
    ++number;
    if (!(joint.travel().min() < joint.travel().max())) continue;  // endless: already among the tool's axes
    JointRow row{make_label("muted", joints_card_), new QLabel(joints_card_), new TravelBar(joints_card_),
                 nullptr, number};
    row.name->setText(QString::fromStdString(joint.name()));
    row.value->setStyleSheet(QStringLiteral("font-family: 'DejaVu Sans Mono', 'Noto Sans Mono', monospace;"));
    row.value->setMinimumWidth(row.value->fontMetrics().horizontalAdvance(QStringLiteral("-00000.000")) + 8);
    row.value->setAlignment(Qt::AlignRight | Qt::AlignAbsolute | Qt::AlignVCenter);
    row.bar->setLayoutDirection(Qt::LeftToRight);
    joints_grid_->addWidget(row.name, i, 0);
    joints_grid_->addWidget(row.bar, i, 1);
    joints_grid_->addWidget(row.value, i, 2);
    if (joint.has_scale()) {
      row.by_scale = make_label("small", joints_card_);
      row.by_scale->setAlignment(Qt::AlignRight | Qt::AlignAbsolute | Qt::AlignVCenter);
      joints_grid_->addWidget(row.by_scale, ++i, 0, 1, 3);
    }
    joints_.push_back(row);
    ++i;
  }
  joints_card_->setVisible(!joints_.isEmpty());
  take_status();
}

void PositionPanel::take_status() {
  const joblink::Status& s = desk_.session.status();
  // What was known when the link broke stays, grey, and is called so.
  const bool lost = desk_.session.link_state() == Session::LinkState::kLost;
  const bool known = (desk_.session.connected() || lost) && s.positions_known();
  const joblink::Pose& t = s.tool();
  const std::array<double, 6> values{
      t.x_mm(), t.y_mm(), t.z_mm(), t.a_rad() * kDegPerRad, t.c_rad() * kDegPerRad, t.e_mm()};
  for (int i = 0; i < 6; ++i) {
    const double v = values[static_cast<std::size_t>(i)];
    const double shown = std::abs(v) < 5e-4 ? 0 : v;
    axes_[i].value->setEnabled(!lost);
    axes_[i].value->setText(known ? Format::number(shown, i == 3 || i == 4 ? 2 : 3) : QStringLiteral("—"));
  }
  frame_text_->setText(lost    ? tr("Last known position")
                       : known ? tr("Tool over the part")
                               : tr("Position not known yet"));
  for (int i = 0; i < joints_.size(); ++i) {
    const int number = joints_[i].joint;
    if (number >= desk_.session.machine().joints_size()) break;  // the gateway was left
    const auto& joint = desk_.session.machine().joints(number);
    const bool here = known && number < s.joints_size();
    const double q = here ? s.joints(number) : 0;
    joints_[i].value->setText(
        here ? Format::number(joint.rotary() ? q * kDegPerRad : q, joint.rotary() ? 2 : 3)
             : QStringLiteral("—"));
    joints_[i].value->setEnabled(!lost);
    if (QLabel* label = joints_[i].by_scale; label != nullptr) {
      const auto words = [&](AxesModel::Column column) {
        return desk_.axes.index(number, column).data().toString();
      };
      const QString there = words(AxesModel::kByScale), error = words(AxesModel::kScaleError);
      label->setText(here && error != QStringLiteral("–") ? tr("By its scale %1 (%2)").arg(there, error)
                                                          : tr("By its scale: read at rest"));
      label->setEnabled(!lost);
    }
    const double span = joint.travel().max() - joint.travel().min();
    // At home a carriage may be a hair beyond its travel.
    const double share = here && span > 0 ? std::clamp((q - joint.travel().min()) / span, 0.0, 1.0) : -1;
    const bool near = share >= 0 && (share < 0.04 || share > 0.96);
    joints_[i].bar->set(share, lost   ? palette().color(QPalette::Mid)
                               : near ? desk_.theme.colours().waiting
                                      : desk_.theme.colours().accent);
  }
}

}  // namespace kinebus::gui
