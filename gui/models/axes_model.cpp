#include "gui/models/axes_model.hpp"

#include <QLatin1Char>
#include <QLocale>
#include <QModelIndex>
#include <QObject>
#include <QString>
#include <QVariant>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gui/models/format.hpp"
#include "gui/session/session.hpp"

namespace kinebus::gui {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;

bool is_number(int column) {
  return column == AxesModel::kPosition || column == AxesModel::kMeasured || column == AxesModel::kError ||
         column == AxesModel::kByScale || column == AxesModel::kScaleError || column == AxesModel::kCurrent ||
         column == AxesModel::kCounts || column == AxesModel::kRun || column == AxesModel::kHold ||
         column == AxesModel::kStage;
}

}  // namespace

AxesModel::AxesModel(Session& session, QObject* parent) : QAbstractTableModel(parent), session_(session) {
  connect(&session, &Session::machine_changed, this, [this] {
    beginResetModel();
    endResetModel();
  });
  connect(&session, &Session::status_changed, this, [this] {
    if (rowCount() > 0) emit dataChanged(index(0, kPosition), index(rowCount() - 1, kSwitch));
  });
}

int AxesModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : session_.machine().joints_size();
}
int AxesModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumns;
}

const joblink::NodeStatus* AxesModel::node_of(const joblink::Joint& joint) const {
  for (const auto& node : session_.status().nodes())
    if (node.id() == joint.node()) return &node;
  return nullptr;
}

const joblink::AxisStatus* AxesModel::axis_of(const joblink::Joint& joint) const {
  const auto* node = node_of(joint);
  const int axis = static_cast<int>(joint.axis());
  return node != nullptr && axis < node->axes_size() ? &node->axes(axis) : nullptr;
}

bool AxesModel::measured() const {
  for (const auto& node : session_.status().nodes())
    for (const auto& axis : node.axes())
      if (axis.has_off_course()) return true;
  return false;
}

bool AxesModel::scaled() const {
  const auto& joints = session_.machine().joints();
  return std::any_of(joints.begin(), joints.end(), [](const joblink::Joint& j) { return j.has_scale(); });
}

QVariant AxesModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal) return {};
  if (role == Qt::TextAlignmentRole && is_number(section))
    return QVariant(Qt::AlignTrailing | Qt::AlignVCenter);
  if (role != Qt::DisplayRole) return {};
  switch (section) {
    case kJoint:
      return tr("Axis");
    case kPosition:
      return tr("Position");
    case kMeasured:
      return tr("Measured");
    case kError:
      return tr("Error");
    case kByScale:
      return tr("By scale");
    case kScaleError:
      return tr("Error by scale");
    case kTravel:
      return tr("Travel");
    case kCounts:
      return tr("Counts");
    case kRun:
      return tr("Run");
    case kHold:
      return tr("Hold");
    case kStage:
      return tr("Stage");
    case kCurrent:
      return tr("Current");
    case kDrive:
      return tr("Drive");
    case kSwitch:
      return tr("Switch");
    case kPlace:
      return tr("Node");
    default:
      return {};
  }
}

QString AxesModel::place_words(const joblink::Joint& joint, double position) {
  return joint.rotary() ? Format::isolated(Format::number(position * kDegPerRad, 2) + QStringLiteral(" °"))
                        : Format::isolated(tr("%1 mm").arg(Format::number(position, 3)));
}

QVariant AxesModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const joblink::Joint& joint = session_.machine().joints(index.row());
  const joblink::Status& status = session_.status();
  const auto* axis = axis_of(joint);
  const auto* node = node_of(joint);
  const bool known = index.row() < status.joints_size() && status.positions_known();
  const double position = known ? status.joints(index.row()) : 0;
  const bool limited = joint.travel().min() < joint.travel().max();
  const bool has_switch = joint.home_switch() != 0;
  const bool switch_on =
      has_switch && node != nullptr && ((node->inputs() >> (joint.home_switch() - 1)) & 1u) != 0;
  if (role == kFault) return axis != nullptr && axis->fault();
  if (role == kSwitchOn) return switch_on;
  if (role == kShare)
    return known && limited
               ? std::clamp((position - joint.travel().min()) / (joint.travel().max() - joint.travel().min()),
                            0.0, 1.0)
               : -1.0;
  if (role == Qt::TextAlignmentRole && is_number(index.column()))
    return QVariant(Qt::AlignTrailing | Qt::AlignVCenter);
  if (role != Qt::DisplayRole) return {};
  switch (index.column()) {
    case kJoint:
      return QString::fromStdString(joint.name());
    case kPosition:
      return known ? place_words(joint, position) : QStringLiteral("–");
    case kMeasured:
      return known && axis != nullptr && axis->has_off_course()
                 ? place_words(joint, position - axis->off_course())
                 : QStringLiteral("–");
    case kError:
      if (axis == nullptr || !axis->has_off_course()) return QStringLiteral("–");
      return joint.rotary()
                 ? Format::isolated(Format::number(-axis->off_course() * kDegPerRad, 3) +
                                    QStringLiteral(" °"))
                 : Format::isolated(tr("%1 µm").arg(Format::number(-axis->off_course() * 1000, 0)));
    case kByScale:
      return axis != nullptr && axis->has_by_scale_mm() ? place_words(joint, axis->by_scale_mm())
                                                        : QStringLiteral("–");
    case kScaleError:
      return known && axis != nullptr && axis->has_by_scale_mm()
                 // + 0.0: no "-0 µm".
                 ? Format::isolated(tr("%1 µm").arg(
                       Format::number(std::round((axis->by_scale_mm() - position) * 1000) + 0.0, 0)))
                 : QStringLiteral("–");
    case kCurrent:
      if (axis == nullptr) return QStringLiteral("–");
      return Format::isolated(
          tr("%1 of %2 A")
              .arg(axis->has_current_a() ? Format::number(axis->current_a(), 2) : QStringLiteral("–"),
                   Format::number(axis->configured_current_a(), 2)));
    case kCounts:
      if (axis == nullptr) return QStringLiteral("–");
      return Format::isolated(QLocale().toString(axis->position_counts()));
    case kRun:
    case kHold:
      if (axis == nullptr) return QStringLiteral("–");
      return Format::isolated(tr("%1 A").arg(
          Format::number(index.column() == kRun ? axis->run_current_a() : axis->hold_current_a(), 2)));
    case kStage:
      return axis != nullptr && axis->has_stage_celsius()
                 ? Format::isolated(Format::temperature(axis->stage_celsius()))
                 : QStringLiteral("–");
    case kDrive:
      if (axis == nullptr) return QStringLiteral("–");
      return axis->fault() ? tr("Fault") : axis->enabled() ? tr("On") : tr("Off");
    case kSwitch:
      return !has_switch ? QStringLiteral("–") : switch_on ? tr("Hit") : tr("Free");
    case kPlace:
      return Format::isolated(QStringLiteral("%1 %2")
                                  .arg(Format::number(joint.node(), 0))
                                  .arg(joint.axis() == 0 ? QLatin1Char('A') : QLatin1Char('B')));
    default:
      return {};
  }
}

}  // namespace kinebus::gui
