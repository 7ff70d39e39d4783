// The page's words in its languages. What the gateway itself says (reasons, events) is said.js's.
const kWords = {
  en: {
    language: 'Language', theme: 'Light or dark', stop: 'EMERGENCY STOP', stop_title: 'Stops all motion and switches all heaters off',
    scene: 'Machine', scene_label: 'The machine and the path of its tool. Arrow keys turn the view, plus and minus change the distance.',
    job: 'Job', progress: 'Progress of the job', pause: 'Pause', resume: 'Resume', cancel: 'Cancel', override: 'Speed', no_job: 'No job',
    temperatures: 'Temperatures', graph_label: 'Temperatures of the last ten minutes', set: 'Set', off: 'Off', target: 'Target of %1, °C', heat_for: 'Heat for %1: %2',
    motion: 'Motion', bring_up: 'Motors on', home: 'Home', reference: 'To the bed reference', clear: 'Clear the stop', motors_off: 'Motors off', step: 'Step', jog: 'Move %1 by the step',
    files: 'Files', upload: 'Upload a job', uploading: 'Uploading: %1', uploaded: 'Stored: %1', name: 'Name', size: 'Size', time: 'Time', actions: 'Actions',
    start: 'Start', remove: 'Delete', download: 'Download', filament: 'Filament', picture_of: 'Picture of %1', of_job: '%1: %2', really: 'Delete %1?',
    history: 'History', begun: 'Begun', result: 'Result', console: 'Console', line: 'Line of G-code', send: 'Send',
    login: 'Connect to the machine', login_words: 'The key is in the file http-key beside the gateway’s jobs; its start tells where.', key: 'Key', connect: 'Connect',
    wrong_key: 'This key is not the gateway’s.', link_lost: 'The link to the gateway is broken. Trying again …', elapsed: '%1 elapsed, %2 left', line_of: 'line %1',
    bus: 'Bus and nodes', bus_graph_label: 'Load of the bus in the last ten minutes, in percent', load: 'Load %1, at most %2', node: 'Node', node_state: 'State', queue: 'Waiting motion', clock: 'Clock within',
    cameras: 'Camera', camera_of: 'Picture of the camera %1', camera_silent: 'The camera sends no picture. Trying again …', macros: 'Macros', macro_words: 'Words for the macro', run_macro: 'Run the macro %1',
    tuning: 'Calibration', heater: 'Heater', good_at: 'Good at', measure: 'Measure', end: 'End', tuning_graph: 'Temperature while it is measured', motor: 'Motor', run_current: 'Moving', hold_current: 'Standing', winding: 'Winding',
    tune_really: '%1 gets full power until it is half of the way to %2 °C. It is hot then, and the machine does nothing else for some minutes. Its fan should blow as it does in a print. Measure it?',
    TUNING_NONE: 'Not measured since the gateway was started', TUNING_BEGINS: 'The measurement begins', TUNING_HEATS: 'It heats with full power', TUNING_COOLS: 'The power is off, its curve is followed', TUNING_FITS: 'The node works out what it has seen, and stores it',
    TUNING_KEEPS: 'The node works out what it has seen, and stores it', TUNING_DONE: 'Measured: its node works by these values from now on', TUNING_FAILED: 'Not measured',
    power_w: 'Power, by the machine file', capacity_j_per_k: 'Heat capacity', loss_w_per_k: 'Loss', dead_s: 'Dead time', lag_s: 'Lag',
    NMT_BOOT_UP: 'starting', NMT_STOPPED: 'stopped', NMT_OPERATIONAL: 'operational', NMT_PRE_OPERATIONAL: 'being set up', NMT_ABSENT: 'silent',
    STATE_OFF: 'off', STATE_BRING_UP: 'starting up', STATE_UNHOMED: 'not homed', STATE_HOMING: 'homing', STATE_READY: 'ready', STATE_MOVING: 'moving',
    STATE_CHECKING: 'checking the job', STATE_RUNNING: 'running', STATE_HOLDING: 'pausing', STATE_HELD: 'paused', STATE_CANCELLING: 'cancelling',
    STATE_STOPPING: 'stopping', STATE_STOPPED: 'stopped', STATE_ALARM: 'alarm',
    JOB_RUNNING: 'running', JOB_COMPLETE: 'complete', JOB_CANCELLED: 'cancelled', JOB_REFUSED: 'refused', JOB_FAILED: 'failed', JOB_INTERRUPTED: 'interrupted',
  },
  tr: {
    language: 'Dil', theme: 'Açık veya koyu', stop: 'ACİL DURDURMA', stop_title: 'Bütün hareketi durdurur ve bütün ısıtıcıları kapatır',
    scene: 'Makine', scene_label: 'Makine ve takımın yolu. Ok tuşları görünümü döndürür, artı ve eksi uzaklığı değiştirir.',
    job: 'İş', progress: 'İşin ilerlemesi', pause: 'Duraklat', resume: 'Sürdür', cancel: 'İptal et', override: 'Hız', no_job: 'İş yok',
    temperatures: 'Sıcaklıklar', graph_label: 'Son on dakikanın sıcaklıkları', set: 'Ayarla', off: 'Kapat', target: '%1 hedefi, °C', heat_for: '%1 için ısıt: %2',
    motion: 'Hareket', bring_up: 'Motorları aç', home: 'Referansa git', reference: 'Tabla referansına git', clear: 'Durdurmayı kaldır', motors_off: 'Motorları kapat', step: 'Adım', jog: '%1 yönünde bir adım',
    files: 'Dosyalar', upload: 'İş yükle', uploading: 'Yükleniyor: %1', uploaded: 'Saklandı: %1', name: 'Ad', size: 'Boyut', time: 'Süre', actions: 'Eylemler',
    start: 'Başlat', remove: 'Sil', download: 'İndir', filament: 'Filament', picture_of: '%1 işinin resmi', of_job: '%1: %2', really: '%1 silinsin mi?',
    history: 'Geçmiş', begun: 'Başlangıç', result: 'Sonuç', console: 'Konsol', line: 'G-kodu satırı', send: 'Gönder',
    login: 'Makineye bağlan', login_words: 'Anahtar, işlerin yanındaki http-key dosyasındadır; yeri başlangıçta söylenir.', key: 'Anahtar', connect: 'Bağlan',
    wrong_key: 'Bu anahtar bu makinenin anahtarı değil.', link_lost: 'Bağlantı koptu. Yeniden deneniyor …', elapsed: '%1 geçti, %2 kaldı', line_of: 'satır %1',
    bus: 'Veri yolu ve düğümler', bus_graph_label: 'Son on dakikada veri yolu yükü, yüzde', load: 'Yük %1, en çok %2', node: 'Düğüm', node_state: 'Durum', queue: 'Bekleyen hareket', clock: 'Saat farkı en çok',
    cameras: 'Kamera', camera_of: '%1 kamerasının görüntüsü', camera_silent: 'Kamera görüntü göndermiyor. Yeniden deneniyor …', macros: 'Makrolar', macro_words: 'Makronun sözcükleri', run_macro: '%1 makrosunu çalıştır',
    tuning: 'Kalibrasyon', heater: 'Isıtıcı', good_at: 'Çalışacağı sıcaklık', measure: 'Ölç', end: 'Bitir', tuning_graph: 'Ölçüm sırasındaki sıcaklık', motor: 'Motor', run_current: 'Hareket akımı', hold_current: 'Duruş akımı', winding: 'Sargı',
    tune_really: '%1, %2 °C yolunun yarısına kadar tam güç alır. Isınır ve makine birkaç dakika başka bir şey yapmaz. Fanı, baskıdaki gibi çalışmalıdır. Ölçülsün mü?',
    TUNING_NONE: 'Ağ geçidi başlatıldığından beri ölçülmedi', TUNING_BEGINS: 'Ölçüm başlıyor', TUNING_HEATS: 'Tam güçle ısıtılıyor', TUNING_COOLS: 'Güç kapalı, eğrisi izleniyor', TUNING_FITS: 'Düğüm gördüklerini hesaplıyor ve saklıyor',
    TUNING_KEEPS: 'Düğüm gördüklerini hesaplıyor ve saklıyor', TUNING_DONE: 'Ölçüldü: düğümü bundan sonra bu değerlerle çalışır', TUNING_FAILED: 'Ölçülmedi',
    power_w: 'Güç (makine dosyasından)', capacity_j_per_k: 'Isı kapasitesi', loss_w_per_k: 'Kayıp', dead_s: 'Ölü zaman', lag_s: 'Gecikme',
    NMT_BOOT_UP: 'başlıyor', NMT_STOPPED: 'durduruldu', NMT_OPERATIONAL: 'çalışıyor', NMT_PRE_OPERATIONAL: 'hazırlanıyor', NMT_ABSENT: 'yanıt vermiyor',
    STATE_OFF: 'kapalı', STATE_BRING_UP: 'açılıyor', STATE_UNHOMED: 'referans yok', STATE_HOMING: 'referansa gidiyor', STATE_READY: 'hazır', STATE_MOVING: 'hareket ediyor',
    STATE_CHECKING: 'iş denetleniyor', STATE_RUNNING: 'çalışıyor', STATE_HOLDING: 'duraklatılıyor', STATE_HELD: 'duraklatıldı', STATE_CANCELLING: 'iptal ediliyor',
    STATE_STOPPING: 'duruyor', STATE_STOPPED: 'durduruldu', STATE_ALARM: 'alarm',
    JOB_RUNNING: 'çalışıyor', JOB_COMPLETE: 'tamamlandı', JOB_CANCELLED: 'iptal edildi', JOB_REFUSED: 'reddedildi', JOB_FAILED: 'başarısız', JOB_INTERRUPTED: 'yarıda kaldı',
  },
  fa: {
    language: 'زبان', theme: 'روشن یا تیره', stop: 'توقف اضطراری', stop_title: 'همهٔ حرکت‌ها را متوقف و همهٔ گرم‌کن‌ها را خاموش می‌کند',
    scene: 'ماشین', scene_label: 'ماشین و مسیر ابزار. کلیدهای جهت نما را می‌چرخانند، به‌علاوه و منها فاصله را تغییر می‌دهند.',
    job: 'کار', progress: 'پیشرفت کار', pause: 'مکث', resume: 'ادامه', cancel: 'لغو', override: 'سرعت', no_job: 'کاری نیست',
    temperatures: 'دماها', graph_label: 'دماهای ده دقیقهٔ گذشته', set: 'تنظیم', off: 'خاموش', target: 'دمای هدف %1، °C', heat_for: 'گرم کردن برای %1: %2',
    motion: 'حرکت', bring_up: 'روشن کردن موتورها', home: 'رفتن به مبدأ', reference: 'رفتن به مرجع بستر', clear: 'رفع توقف', motors_off: 'خاموش کردن موتورها', step: 'گام', jog: 'یک گام در جهت %1',
    files: 'پرونده‌ها', upload: 'بارگذاری کار', uploading: 'در حال بارگذاری: %1', uploaded: 'ذخیره شد: %1', name: 'نام', size: 'اندازه', time: 'زمان', actions: 'کارها',
    start: 'شروع', remove: 'حذف', download: 'دریافت', filament: 'فیلامنت', picture_of: 'تصویر %1', of_job: '%1: %2', really: '%1 حذف شود؟',
    history: 'تاریخچه', begun: 'آغاز', result: 'نتیجه', console: 'کنسول', line: 'سطر جی‌کد', send: 'ارسال',
    login: 'اتصال به ماشین', login_words: 'کلید در پروندهٔ http-key کنار کارهاست؛ جای آن هنگام آغاز گفته می‌شود.', key: 'کلید', connect: 'اتصال',
    wrong_key: 'این کلید، کلید این ماشین نیست.', link_lost: 'اتصال قطع شد. تلاش دوباره …', elapsed: '%1 گذشته، %2 مانده', line_of: 'سطر %1',
    bus: 'گذرگاه و گره‌ها', bus_graph_label: 'بار گذرگاه در ده دقیقهٔ گذشته، به درصد', load: 'بار %1، بیشینه %2', node: 'گره', node_state: 'وضعیت', queue: 'حرکت در صف', clock: 'دقت ساعت',
    cameras: 'دوربین', camera_of: 'تصویر دوربین %1', camera_silent: 'دوربین تصویری نمی‌فرستد. تلاش دوباره …', macros: 'ماکروها', macro_words: 'واژه‌های ماکرو', run_macro: 'اجرای ماکروی %1',
    tuning: 'کالیبراسیون', heater: 'گرم‌کن', good_at: 'دمای کار', measure: 'اندازه‌گیری', end: 'پایان', tuning_graph: 'دما هنگام اندازه‌گیری', motor: 'موتور', run_current: 'جریان حرکت', hold_current: 'جریان ایست', winding: 'سیم‌پیچ',
    tune_really: '%1 تا نیمهٔ راه به %2 °C توان کامل می‌گیرد. داغ می‌شود و ماشین چند دقیقه کار دیگری نمی‌کند. فن آن باید مانند هنگام چاپ بوزد. اندازه‌گیری شود؟',
    TUNING_NONE: 'از آغاز کار درگاه اندازه‌گیری نشده است', TUNING_BEGINS: 'اندازه‌گیری آغاز می‌شود', TUNING_HEATS: 'با توان کامل گرم می‌شود', TUNING_COOLS: 'توان قطع است، منحنی‌اش دنبال می‌شود', TUNING_FITS: 'گره آنچه را دیده است حساب و ذخیره می‌کند',
    TUNING_KEEPS: 'گره آنچه را دیده است حساب و ذخیره می‌کند', TUNING_DONE: 'اندازه‌گیری شد: گره‌اش از این پس با این مقدارها کار می‌کند', TUNING_FAILED: 'اندازه‌گیری نشد',
    power_w: 'توان (از پروندهٔ ماشین)', capacity_j_per_k: 'ظرفیت حرارتی', loss_w_per_k: 'اتلاف', dead_s: 'زمان مرده', lag_s: 'تأخیر',
    NMT_BOOT_UP: 'در حال آغاز', NMT_STOPPED: 'متوقف', NMT_OPERATIONAL: 'در کار', NMT_PRE_OPERATIONAL: 'در حال آماده‌سازی', NMT_ABSENT: 'پاسخ نمی‌دهد',
    STATE_OFF: 'خاموش', STATE_BRING_UP: 'در حال راه‌اندازی', STATE_UNHOMED: 'بدون مبدأ', STATE_HOMING: 'رفتن به مبدأ', STATE_READY: 'آماده', STATE_MOVING: 'در حرکت',
    STATE_CHECKING: 'بررسی کار', STATE_RUNNING: 'در حال اجرا', STATE_HOLDING: 'در حال مکث', STATE_HELD: 'مکث', STATE_CANCELLING: 'در حال لغو',
    STATE_STOPPING: 'در حال توقف', STATE_STOPPED: 'متوقف', STATE_ALARM: 'هشدار',
    JOB_RUNNING: 'در حال اجرا', JOB_COMPLETE: 'کامل', JOB_CANCELLED: 'لغو شد', JOB_REFUSED: 'رد شد', JOB_FAILED: 'ناموفق', JOB_INTERRUPTED: 'ناتمام',
  },
};

const known = (language) => (language in kWords ? language : 'en');
let language = known(localStorage.getItem('language') ?? navigator.language.slice(0, 2));

export const t = (word, ...parts) => parts.reduce((text, part, i) => text.replace(`%${i + 1}`, part), kWords[language][word] ?? kWords.en[word] ?? word);
/// No "-0.00".
export const number = (value, digits = 0) => (Number(value.toFixed(digits)) || 0).toLocaleString(language, { minimumFractionDigits: digits, maximumFractionDigits: digits });
export const percent = (share, digits = 0) => share.toLocaleString(language, { style: 'percent', minimumFractionDigits: digits, maximumFractionDigits: digits });
export const date = (unix_s) => new Date(unix_s * 1000).toLocaleString(language, { dateStyle: 'short', timeStyle: 'short' });
export const present_language = () => language;

export function duration(seconds) {
  const s = Math.max(0, Math.round(seconds));
  const two = (n) => number(n).padStart(2, number(0));
  return `${number(Math.floor(s / 3600))}:${two(Math.floor(s / 60) % 60)}:${two(s % 60)}`;
}

/// Puts the language's words into all that asks for them by data-t, data-t-label or data-t-title.
export function say_all(root = document) {
  document.documentElement.lang = language;
  document.documentElement.dir = language === 'fa' ? 'rtl' : 'ltr';
  for (const one of root.querySelectorAll('[data-t]')) one.textContent = t(one.dataset.t);
  for (const one of root.querySelectorAll('[data-t-label]')) one.setAttribute('aria-label', t(one.dataset.tLabel));
  for (const one of root.querySelectorAll('[data-t-title]')) one.title = t(one.dataset.tTitle);
}

export function choose_language(chosen) {
  language = known(chosen);
  localStorage.setItem('language', language);
  say_all();
}
