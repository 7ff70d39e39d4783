#pragma once
// Puts the pages together: bar on top, pages at the side, position and job in docks that can be moved.

#include <QCloseEvent>
#include <QDockWidget>
#include <QEvent>
#include <QLabel>
#include <QMainWindow>
#include <QStackedWidget>
#include <QTimer>
#include <QWidget>

#include "gui/views/desk.hpp"

class QButtonGroup;
class QSettings;

namespace kinebus::gui {

class AlarmsPage;
class ConnectPage;
class ConsolePage;
class JobsPage;
class JogPage;
class MachinePage;
class Notice;
class TopBar;
class ViewPage;

class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  enum Page { kConnect, kView, kJobs, kJog, kConsole, kAlarms, kMachine, kPages };
  explicit MainWindow(Desk& desk);

  void show_page(Page page);
  Page page() const;
  void set_theme(bool dark);
  void set_language(const QString& code);
  void save(QSettings& settings) const;
  void restore(QSettings& settings);

  ViewPage& view_page() { return *view_; }
  JobsPage& jobs_page() { return *jobs_; }
  ConsolePage& console_page() { return *console_; }
  MachinePage& machine_page() { return *machine_; }
  ConnectPage& connect_page() { return *connect_; }
  TopBar& top_bar() { return *top_; }
  Notice& notice() { return *notice_; }

 protected:
  void closeEvent(QCloseEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  QWidget* make_navigation();
  QDockWidget* make_dock(const QString& name, QWidget* content);
  void retranslate();
  /// The panels stand where a line of text ends: right, or left when one reads from right to left.
  void mirror_docks();
  void tell_alarm();
  void take_link();
  /// A demo machine ends with this window: a print on it is not ended by a slip.
  void ask_before_the_demo_ends();

  Desk& desk_;
  TopBar* top_;
  QStackedWidget* pages_;
  QButtonGroup* navigation_;
  ConnectPage* connect_;
  ViewPage* view_;
  JobsPage* jobs_;
  JogPage* jog_;
  ConsolePage* console_;
  AlarmsPage* alarms_;
  MachinePage* machine_;
  QDockWidget *position_dock_, *job_dock_;
  Notice* notice_;
  bool was_connected_ = false;
  bool docks_mirrored_ = false;
  bool end_of_demo_is_wanted_ = false;
};

}  // namespace kinebus::gui
