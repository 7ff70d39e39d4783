#pragma once
// What the pre-flight of a job, or the check of a machine file, has found.

#include <QAbstractTableModel>
#include <QModelIndex>
#include <QVariant>
#include <QVector>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

struct ShownProblem {
  bool error = true;
  int line = 0;  ///< from 1; 0: the whole
  int column = 0;
  joblink::Problem problem{};  ///< said when it is shown: the language may change
};

class ProblemsModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  enum Column { kKind, kLine, kWords, kColumns };
  enum Role { kIsError = Qt::UserRole };
  using QAbstractTableModel::QAbstractTableModel;
  void set(QVector<ShownProblem> problems);
  static QVector<ShownProblem> of(const joblink::PreflightResult& result);
  static QVector<ShownProblem> of(const joblink::MachineFileCheck& check);
  const ShownProblem& at(int row) const { return problems_[row]; }
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  QVector<ShownProblem> problems_;
};

}  // namespace kinebus::gui
