#include "gui/models/problems_model.hpp"

#include <QLocale>
#include <QModelIndex>
#include <QVariant>

#include "gui/session/gateway_words.hpp"

namespace kinebus::gui {

void ProblemsModel::set(QVector<ShownProblem> problems) {
  beginResetModel();
  problems_ = std::move(problems);
  endResetModel();
}

QVector<ShownProblem> ProblemsModel::of(const joblink::PreflightResult& result) {
  QVector<ShownProblem> list;
  for (const auto& p : result.problems()) {
    joblink::Problem problem;
    problem.set_rule(p.words());
    *problem.mutable_rule_said() = p.said();
    list.push_back({p.error(), static_cast<int>(p.line()), static_cast<int>(p.column()), std::move(problem)});
  }
  return list;
}

QVector<ShownProblem> ProblemsModel::of(const joblink::MachineFileCheck& check) {
  QVector<ShownProblem> list;
  for (const auto& p : check.problems())
    list.push_back({true, static_cast<int>(p.line()), static_cast<int>(p.column()), p});
  return list;
}

int ProblemsModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(problems_.size());
}

int ProblemsModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumns;
}

QVariant ProblemsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const ShownProblem& p = problems_[index.row()];
  if (role == kIsError) return p.error;
  // Translated when it is shown: the language may have changed since.
  if (role == Qt::ToolTipRole) return GatewayWords::said(p.problem);
  if (role == Qt::TextAlignmentRole && index.column() == kLine)
    return QVariant(Qt::AlignTrailing | Qt::AlignVCenter);
  if (role != Qt::DisplayRole) return {};
  switch (index.column()) {
    case kKind:
      return p.error ? tr("Error") : tr("Warning");
    case kLine:
      return p.line > 0 ? QLocale().toString(p.line) : QString();
    case kWords:
      return GatewayWords::said(p.problem);
    default:
      return {};
  }
}

QVariant ProblemsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  return section == kKind ? tr("Kind") : section == kLine ? tr("Line") : tr("What is wrong");
}

}  // namespace kinebus::gui
