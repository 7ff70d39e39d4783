#pragma once
// The joints of the machine: where each is, what its motor gets, its switch.

#include <QAbstractTableModel>
#include <QModelIndex>
#include <QVariant>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

class Session;

class AxesModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  enum Column {
    kJoint,
    kPosition,
    kMeasured,
    kError,
    kByScale,
    kScaleError,
    kTravel,
    kCounts,
    kRun,
    kHold,
    kCurrent,
    kStage,
    kDrive,
    kSwitch,
    kPlace,
    kColumns
  };
  enum Role { kShare = Qt::UserRole, kFault, kSwitchOn };
  explicit AxesModel(Session& session, QObject* parent = nullptr);
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  /// Whether any axis is measured by an encoder: else kMeasured and kError have nothing to say.
  bool measured() const;
  /// Whether any axis has a linear scale: else kByScale and kScaleError have nothing to say.
  bool scaled() const;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  const joblink::NodeStatus* node_of(const joblink::Joint& joint) const;
  const joblink::AxisStatus* axis_of(const joblink::Joint& joint) const;
  static QString place_words(const joblink::Joint& joint, double position);
  Session& session_;
};

}  // namespace kinebus::gui
