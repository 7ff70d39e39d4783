#pragma once
// The jobs on the gateway: upload by dropping a file, check, start, and what the check has found, with the
// way to the line and to the place.

#include <QDragEnterEvent>
#include <QDragLeaveEvent>
#include <QDropEvent>
#include <QLabel>
#include <QMap>
#include <QPushButton>
#include <QStringList>
#include <QTableView>
#include <QWidget>

#include "gui/models/problems_model.hpp"
#include "gui/views/desk.hpp"
#include "gui/views/line_view.hpp"
#include "gui/views/widgets.hpp"

class QSplitter;

namespace kinebus::gui {

class JobsPage : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit JobsPage(Desk& desk, QWidget* parent = nullptr);
  void upload(const QStringList& paths);
  void select(const QString& job_name);
  /// Checks the selected job and shows what was found.
  void check();
  bool checking() const { return checking_; }

 signals:
  void show_place(std::uint32_t line);
  void show_view();

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dragLeaveEvent(QDragLeaveEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  QWidget* make_drop_zone();
  QWidget* make_table();
  QWidget* make_result();
  QString selected_job() const;
  void take_selection();
  void take_result(const QString& name, const joblink::Reply& reply);
  /// The job that was started was checked once more: what was found is shown, whether it begins or not.
  void take_start();
  void ask_to_delete();
  void choose_file();
  void tell_store();

  Desk& desk_;
  ProblemsModel problems_;
  QWidget* drop_zone_;
  QTableView *table_ = nullptr, *problems_table_ = nullptr;
  LineView* lines_;
  QPushButton *start_, *check_, *show_, *delete_;
  QLabel *store_text_, *result_text_, *result_heading_;
  QSplitter* splitter_;
  /// What the newest check of a job has found; of the text that had this hash.
  struct Result {
    std::string hash;
    QVector<ShownProblem> problems;
    joblink::PreflightSummary summary;
    bool checked = false;  ///< false: the check itself was refused
  };
  void show_result();
  QMap<QString, Result> results_;
  QString shown_job_, checked_job_;
  bool checking_ = false;
};

}  // namespace kinebus::gui
