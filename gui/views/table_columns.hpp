#pragma once
// The columns of a table: each as wide as the widest that it has had to show in the language at work, and
// what room is left shared out; where there is too little, the table is scrolled sideways. Values that change
// never make columns jump to and fro.

#include <QEvent>
#include <QObject>
#include <QTableView>
#include <QVector>

namespace kinebus::gui {

class TableColumns : public QObject {
  Q_OBJECT
 public:
  /// Takes over the widths of `table`'s columns; belongs to it. `least`: of every column, pixels.
  explicit TableColumns(QTableView* table, int least = 40);
  /// Other words: begins anew.
  void forget();
  void fit();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  QTableView* table_;
  int least_;
  QVector<int> needed_;
};

}  // namespace kinebus::gui
