<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="tr" sourcelanguage="en">
    <context>
        <name>AlarmWords</name>
        <message>
            <source>A node does not answer</source>
            <translation>Bir düğüm yanıt vermiyor</translation>
        </message>
        <message>
            <source>The wrong node is connected</source>
            <translation>Yanlış düğüm bağlı</translation>
        </message>
        <message>
            <source>A node refuses its settings</source>
            <translation>Bir düğüm ayarlarını kabul etmiyor</translation>
        </message>
        <message>
            <source>A drive does not switch on</source>
            <translation>Bir sürücü açılmıyor</translation>
        </message>
        <message>
            <source>There is a second gateway on the bus</source>
            <translation>Veri yolunda ikinci bir ağ geçidi var</translation>
        </message>
        <message>
            <source>A node has gone silent</source>
            <translation>Bir düğüm sustu</translation>
        </message>
        <message>
            <source>A node has restarted</source>
            <translation>Bir düğüm yeniden başladı</translation>
        </message>
        <message>
            <source>The clocks have drifted apart</source>
            <translation>Saatler birbirinden ayrıldı</translation>
        </message>
        <message>
            <source>Homing has failed</source>
            <translation>Eve dönüş başarısız oldu</translation>
        </message>
        <message>
            <source>The carriages are too far apart</source>
            <translation>Arabalar birbirinden çok uzak</translation>
        </message>
        <message>
            <source>Homing took too long</source>
            <translation>Eve dönüş çok uzun sürdü</translation>
        </message>
        <message>
            <source>Motion was interrupted</source>
            <translation>Hareket kesildi</translation>
        </message>
        <message>
            <source>The nodes disagree about the path</source>
            <translation>Düğümler yol üzerinde anlaşamıyor</translation>
        </message>
        <message>
            <source>The bus has failed</source>
            <translation>Veri yolu arızalandı</translation>
        </message>
        <message>
            <source>A heater is not as it should be</source>
            <translation>Bir ısıtıcı olması gerektiği gibi değil</translation>
        </message>
        <message>
            <source>The job went wrong</source>
            <translation>İş ters gitti</translation>
        </message>
        <message>
            <source>Stopped by the operator</source>
            <translation>Operatör tarafından durduruldu</translation>
        </message>
        <message>
            <source>The machine did not come to rest</source>
            <translation>Makine durmadı</translation>
        </message>
        <message>
            <source>Two nodes use the same id</source>
            <translation>İki düğüm aynı kimliği kullanıyor</translation>
        </message>
        <message>
            <source>Too much current in a motor</source>
            <translation>Bir motorda aşırı akım</translation>
        </message>
        <message>
            <source>The supply voltage is wrong</source>
            <translation>Besleme gerilimi hatalı</translation>
        </message>
        <message>
            <source>A drive is too hot</source>
            <translation>Bir sürücü çok sıcak</translation>
        </message>
        <message>
            <source>Communication trouble on the bus</source>
            <translation>Veri yolunda iletişim sorunu</translation>
        </message>
        <message>
            <source>A carriage is not where it should be</source>
            <translation>Bir araba olması gereken yerde değil</translation>
        </message>
        <message>
            <source>Message</source>
            <translation>İleti</translation>
        </message>
        <message>
            <source>A node reports a fault</source>
            <translation>Bir düğüm arıza bildiriyor</translation>
        </message>
        <message>
            <source>Check the node's power and the bus cable, then home again.</source>
            <translation>Düğümün beslemesini ve veri yolu kablosunu denetleyin, sonra yeniden eve gönderin.</translation>
        </message>
        <message>
            <source>Connect the right node or update its firmware.</source>
            <translation>Doğru düğümü bağlayın ya da yazılımını güncelleyin.</translation>
        </message>
        <message>
            <source>Check the machine file against the node's limits.</source>
            <translation>Makine dosyasını düğümün sınırlarıyla karşılaştırın.</translation>
        </message>
        <message>
            <source>Look at the drive's fault, clear the alarm, then home again.</source>
            <translation>Sürücünün arızasına bakın, alarmı temizleyin, sonra yeniden eve gönderin.</translation>
        </message>
        <message>
            <source>Switch one of the gateways off.</source>
            <translation>Ağ geçitlerinden birini kapatın.</translation>
        </message>
        <message>
            <source>Check the node's power and the bus cable, then clear and home again.</source>
            <translation>Düğümün beslemesini ve veri yolu kablosunu denetleyin, sonra temizleyip yeniden eve gönderin.</translation>
        </message>
        <message>
            <source>Check the node's power, then clear and home again.</source>
            <translation>Düğümün beslemesini denetleyin, sonra temizleyip yeniden eve gönderin.</translation>
        </message>
        <message>
            <source>Check the bus for errors, then clear.</source>
            <translation>Veri yolunda hata arayın, sonra temizleyin.</translation>
        </message>
        <message>
            <source>Check the switch and its wiring, then clear and home again.</source>
            <translation>Anahtarı ve kablosunu denetleyin, sonra temizleyip yeniden eve gönderin.</translation>
        </message>
        <message>
            <source>Check the switches of the carriages that went on, then clear and home again.</source>
            <translation>İlerleyen arabaların anahtarlarını denetleyin, sonra temizleyip yeniden eve gönderin.</translation>
        </message>
        <message>
            <source>Check the switches and the homing speeds, then clear and home again.</source>
            <translation>Anahtarları ve eve dönüş hızlarını denetleyin, sonra temizleyip yeniden eve gönderin.</translation>
        </message>
        <message>
            <source>Clear: positions are known, the job can be run again.</source>
            <translation>Temizleyin: konumlar biliniyor, iş yeniden çalıştırılabilir.</translation>
        </message>
        <message>
            <source>Clear. If it comes again, check the bus for lost frames.</source>
            <translation>Temizleyin. Yinelenirse veri yolunda kayıp çerçeve arayın.</translation>
        </message>
        <message>
            <source>Check cable and termination of the bus, then clear and home again.</source>
            <translation>Veri yolunun kablosunu ve sonlandırmasını denetleyin, sonra temizleyip yeniden eve gönderin.</translation>
        </message>
        <message>
            <source>Check the heater and its sensor, then clear.</source>
            <translation>Isıtıcıyı ve algılayıcısını denetleyin, sonra temizleyin.</translation>
        </message>
        <message>
            <source>Correct the job, then clear.</source>
            <translation>İşi düzeltin, sonra temizleyin.</translation>
        </message>
        <message>
            <source>Clear when the machine is safe.</source>
            <translation>Makine güvenli olduğunda temizleyin.</translation>
        </message>
        <message>
            <source>Switch the machine off and on, then home again.</source>
            <translation>Makineyi kapatıp açın, sonra yeniden eve gönderin.</translation>
        </message>
        <message>
            <source>Give one of them another id or take it off the bus, then home again.</source>
            <translation>Birine başka bir kimlik verin ya da onu veri yolundan çıkarın, sonra yeniden eve gönderin.</translation>
        </message>
    </context>
    <context>
        <name>ConsoleHints</name>
        <message>
            <source>traverse</source>
            <translation>hızlı konumlama</translation>
        </message>
        <message>
            <source>straight line at feed</source>
            <translation>ilerlemeyle doğru çizgi</translation>
        </message>
        <message>
            <source>arc, clockwise</source>
            <translation>yay, saat yönünde</translation>
        </message>
        <message>
            <source>arc, counter-clockwise</source>
            <translation>yay, saat yönünün tersine</translation>
        </message>
        <message>
            <source>home, or go to the bed reference</source>
            <translation>eve dön ya da tabla referansına git</translation>
        </message>
        <message>
            <source>first work coordinate system</source>
            <translation>birinci iş koordinat sistemi</translation>
        </message>
        <message>
            <source>second work coordinate system</source>
            <translation>ikinci iş koordinat sistemi</translation>
        </message>
        <message>
            <source>absolute positions</source>
            <translation>mutlak konumlar</translation>
        </message>
        <message>
            <source>relative positions</source>
            <translation>göreli konumlar</translation>
        </message>
        <message>
            <source>call this position so</source>
            <translation>bu konumu böyle adlandır</translation>
        </message>
        <message>
            <source>motors on</source>
            <translation>motorlar açık</translation>
        </message>
        <message>
            <source>motors off</source>
            <translation>motorlar kapalı</translation>
        </message>
        <message>
            <source>list the jobs</source>
            <translation>işleri listele</translation>
        </message>
        <message>
            <source>choose a job</source>
            <translation>iş seç</translation>
        </message>
        <message>
            <source>start or resume</source>
            <translation>başlat ya da sürdür</translation>
        </message>
        <message>
            <source>pause</source>
            <translation>duraklat</translation>
        </message>
        <message>
            <source>progress of the job</source>
            <translation>işin ilerlemesi</translation>
        </message>
        <message>
            <source>time of the job</source>
            <translation>işin süresi</translation>
        </message>
        <message>
            <source>extruder absolute</source>
            <translation>ekstruder mutlak</translation>
        </message>
        <message>
            <source>extruder relative</source>
            <translation>ekstruder göreli</translation>
        </message>
        <message>
            <source>heat the nozzle</source>
            <translation>nozulu ısıt</translation>
        </message>
        <message>
            <source>temperatures</source>
            <translation>sıcaklıklar</translation>
        </message>
        <message>
            <source>fan on</source>
            <translation>fan açık</translation>
        </message>
        <message>
            <source>fan off</source>
            <translation>fan kapalı</translation>
        </message>
        <message>
            <source>heat the nozzle and wait</source>
            <translation>nozulu ısıt ve bekle</translation>
        </message>
        <message>
            <source>emergency stop</source>
            <translation>acil durdurma</translation>
        </message>
        <message>
            <source>position</source>
            <translation>konum</translation>
        </message>
        <message>
            <source>name and capabilities</source>
            <translation>ad ve yetenekler</translation>
        </message>
        <message>
            <source>switches</source>
            <translation>anahtarlar</translation>
        </message>
        <message>
            <source>heat the bed</source>
            <translation>tablayı ısıt</translation>
        </message>
    </context>
    <context>
        <name>Desk</name>
        <message>
            <source>Demo machine</source>
            <translation>Deneme makinesi</translation>
        </message>
    </context>
    <context>
        <name>Format</name>
        <message>
            <source>%1 B</source>
            <translation>%1 B</translation>
        </message>
        <message>
            <source>%1 kB</source>
            <translation>%1 kB</translation>
        </message>
        <message>
            <source>%1 MB</source>
            <translation>%1 MB</translation>
        </message>
        <message>
            <source>%1 GB</source>
            <translation>%1 GB</translation>
        </message>
        <message>
            <source>%1/s</source>
            <translation>%1/sn</translation>
        </message>
        <message>
            <source>%1 °C</source>
            <translation>%1 °C</translation>
        </message>
    </context>
    <context>
        <name>StateWords</name>
        <message>
            <source>Motors off</source>
            <translation>Motorlar kapalı</translation>
        </message>
        <message>
            <source>Waking the nodes</source>
            <translation>Düğümler uyandırılıyor</translation>
        </message>
        <message>
            <source>Not homed</source>
            <translation>Ev konumu bilinmiyor</translation>
        </message>
        <message>
            <source>Homing</source>
            <translation>Eve dönüyor</translation>
        </message>
        <message>
            <source>Ready</source>
            <translation>Hazır</translation>
        </message>
        <message>
            <source>Moving</source>
            <translation>Hareket ediyor</translation>
        </message>
        <message>
            <source>Checking the job</source>
            <translation>İş denetleniyor</translation>
        </message>
        <message>
            <source>Printing</source>
            <translation>Basıyor</translation>
        </message>
        <message>
            <source>Pausing</source>
            <translation>Duraklıyor</translation>
        </message>
        <message>
            <source>Paused</source>
            <translation>Duraklatıldı</translation>
        </message>
        <message>
            <source>Cancelling</source>
            <translation>İptal ediliyor</translation>
        </message>
        <message>
            <source>Stopping</source>
            <translation>Duruyor</translation>
        </message>
        <message>
            <source>Stopped</source>
            <translation>Durdu</translation>
        </message>
        <message>
            <source>Alarm</source>
            <translation>Alarm</translation>
        </message>
        <message>
            <source>Unknown</source>
            <translation>Bilinmiyor</translation>
        </message>
        <message>
            <source>Home the machine to wake the motors and find the carriages.</source>
            <translation>Motorları uyandırmak ve arabaları bulmak için makineyi eve gönderin.</translation>
        </message>
        <message>
            <source>Home the machine: positions are not known yet.</source>
            <translation>Makineyi eve gönderin: konumlar henüz bilinmiyor.</translation>
        </message>
        <message>
            <source>Choose a job and start it, or jog the tool.</source>
            <translation>Bir iş seçip başlatın ya da takımı elle sürün.</translation>
        </message>
        <message>
            <source>All carriages rest on the path. Resume or cancel.</source>
            <translation>Bütün arabalar yol üzerinde duruyor. Sürdürün ya da iptal edin.</translation>
        </message>
        <message>
            <source>Make sure that the machine is safe, then clear the stop.</source>
            <translation>Makinenin güvenli olduğundan emin olun, sonra durdurmayı temizleyin.</translation>
        </message>
        <message>
            <source>Read the alarm, remove its cause, then clear it.</source>
            <translation>Alarmı okuyun, nedenini giderin, sonra temizleyin.</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::AlarmsPage</name>
        <message>
            <source>Clear</source>
            <translation>Temizle</translation>
        </message>
        <message>
            <source>No alarm is open.</source>
            <translation>Açık alarm yok.</translation>
        </message>
        <message>
            <source>What has happened, newest first</source>
            <translation>Olanlar, en yenisi önce</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::AxesModel</name>
        <message>
            <source>Axis</source>
            <translation>Eksen</translation>
        </message>
        <message>
            <source>Position</source>
            <translation>Konum</translation>
        </message>
        <message>
            <source>Measured</source>
            <translation>Ölçülen</translation>
        </message>
        <message>
            <source>Error</source>
            <translation>Hata</translation>
        </message>
        <message>
            <source>%1 µm</source>
            <translation>%1 µm</translation>
        </message>
        <message>
            <source>Travel</source>
            <translation>Strok</translation>
        </message>
        <message>
            <source>Current</source>
            <translation>Akım</translation>
        </message>
        <message>
            <source>Drive</source>
            <translation>Sürücü</translation>
        </message>
        <message>
            <source>Switch</source>
            <translation>Anahtar</translation>
        </message>
        <message>
            <source>Node</source>
            <translation>Düğüm</translation>
        </message>
        <message>
            <source>%1 mm</source>
            <translation>%1 mm</translation>
        </message>
        <message>
            <source>%1 A</source>
            <translation>%1 A</translation>
        </message>
        <message>
            <source>Fault</source>
            <translation>Arıza</translation>
        </message>
        <message>
            <source>On</source>
            <translation>Açık</translation>
        </message>
        <message>
            <source>Off</source>
            <translation>Kapalı</translation>
        </message>
        <message>
            <source>Hit</source>
            <translation>Basılı</translation>
        </message>
        <message>
            <source>Free</source>
            <translation>Serbest</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::ConnectPage</name>
        <message>
            <source>Connect to a machine</source>
            <translation>Bir makineye bağlanın</translation>
        </message>
        <message>
            <source>A gateway appears here as soon as its USB cable is plugged in or its daemon runs on this computer.</source>
            <translation>Bir ağ geçidi, USB kablosu takılır takılmaz ya da arka plan programı bu bilgisayarda çalışır çalışmaz burada görünür.</translation>
        </message>
        <message>
            <source>Gateways</source>
            <translation>Ağ geçitleri</translation>
        </message>
        <message>
            <source>None found yet.</source>
            <translation>Henüz bulunamadı.</translation>
        </message>
        <message>
            <source>Demo machine</source>
            <translation>Deneme makinesi</translation>
        </message>
        <message>
            <source>The whole machine, simulated on this computer: upload, home and print without hardware.</source>
            <translation>Bütün makine bu bilgisayarda benzetimle: donanım olmadan yükleyin, eve gönderin ve basın.</translation>
        </message>
        <message>
            <source>Try the demo</source>
            <translation>Denemeyi başlat</translation>
        </message>
        <message>
            <source>Disconnect</source>
            <translation>Bağlantıyı kes</translation>
        </message>
        <message>
            <source>The demo machine does not run: %1</source>
            <translation>Deneme makinesi çalışmıyor: %1</translation>
        </message>
        <message>
            <source>Connect</source>
            <translation>Bağlan</translation>
        </message>
        <message>
            <source>Connect to %1</source>
            <translation>%1 ile bağlan</translation>
        </message>
        <message>
            <source>Connecting to %1…</source>
            <translation>%1 ile bağlanılıyor…</translation>
        </message>
        <message>
            <source>%1 does not answer: %2</source>
            <translation>%1 yanıt vermiyor: %2</translation>
        </message>
        <message>
            <source>Connected to %1.</source>
            <translation>%1 ile bağlantı kuruldu.</translation>
        </message>
        <message>
            <source>The connection is lost: %1. It comes back by itself; a job on the machine goes on.</source>
            <translation>Bağlantı koptu: %1. Kendiliğinden geri gelir; makinedeki iş sürer.</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::ConsolePage</name>
        <message>
            <source>Send</source>
            <translation>Gönder</translation>
        </message>
        <message>
            <source>Answers of the gateway</source>
            <translation>Ağ geçidinin yanıtları</translation>
        </message>
        <message>
            <source>Lines you send and the gateway's answers appear here.</source>
            <translation>Gönderdiğiniz satırlar ve ağ geçidinin yanıtları burada görünür.</translation>
        </message>
        <message>
            <source>G-code or M-code, for example M114</source>
            <translation>G kodu ya da M kodu, örneğin M114</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::DemoGateway</name>
        <message>
            <source>the demo machine has ended</source>
            <translation>deneme makinesi sonlandı</translation>
        </message>
        <message>
            <source>the program kinebusd was not found: install the package kinebus-daemon</source>
            <translation>kinebusd programı bulunamadı: kinebus-daemon paketini kurun</translation>
        </message>
        <message>
            <source>the demo machine does not answer</source>
            <translation>deneme makinesi yanıt vermiyor</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::EventsModel</name>
        <message>
            <source>Done</source>
            <translation>Bitti</translation>
        </message>
        <message>
            <source>The check of the job found a problem</source>
            <translation>İşin denetimi bir sorun buldu</translation>
        </message>
        <message>
            <source>Control has moved to another program</source>
            <translation>Denetim başka bir programa geçti</translation>
        </message>
        <message>
            <source>Message</source>
            <translation>İleti</translation>
        </message>
        <message>
            <source>node %1</source>
            <translation>düğüm %1</translation>
        </message>
        <message>
            <source>line %1</source>
            <translation>satır %1</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::GatewayFinder</name>
        <message>
            <source>USB %1 · serial number %2</source>
            <translation>USB %1 · seri numarası %2</translation>
        </message>
        <message>
            <source>Gateway on this computer</source>
            <translation>Bu bilgisayardaki ağ geçidi</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::JobPanel</name>
        <message>
            <source>Interrupted: resume goes on from its place.</source>
            <translation>Yarıda kaldı: Sürdür, kaldığı yerden devam eder.</translation>
        </message>
        <message>
            <source>Progress</source>
            <translation>İlerleme</translation>
        </message>
        <message>
            <source>Elapsed</source>
            <translation>Geçen süre</translation>
        </message>
        <message>
            <source>Remaining</source>
            <translation>Kalan süre</translation>
        </message>
        <message>
            <source>Line</source>
            <translation>Satır</translation>
        </message>
        <message>
            <source>Cancel the job</source>
            <translation>İşi iptal et</translation>
        </message>
        <message>
            <source>Cancel the job? What is printed stays on the bed.</source>
            <translation>İş iptal edilsin mi? Basılan kısım tablada kalır.</translation>
        </message>
        <message>
            <source>Go on</source>
            <translation>Sürdür</translation>
        </message>
        <message>
            <source>Speed</source>
            <translation>Hız</translation>
        </message>
        <message>
            <source>Feed override in percent</source>
            <translation>Yüzde olarak ilerleme çarpanı</translation>
        </message>
        <message>
            <source>Pause</source>
            <translation>Duraklat</translation>
        </message>
        <message>
            <source>Resume</source>
            <translation>Sürdür</translation>
        </message>
        <message>
            <source>Cancel</source>
            <translation>İptal</translation>
        </message>
        <message>
            <source>No job is running</source>
            <translation>Çalışan iş yok</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::JobUpload</name>
        <message>
            <source>%1 cannot be read</source>
            <translation>%1 okunamıyor</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::JobsModel</name>
        <message>
            <source>Job</source>
            <translation>İş</translation>
        </message>
        <message>
            <source>Size</source>
            <translation>Boyut</translation>
        </message>
        <message>
            <source>Uploaded</source>
            <translation>Yüklendi</translation>
        </message>
        <message>
            <source>Check</source>
            <translation>Denetle</translation>
        </message>
        <message>
            <source>Time</source>
            <translation>Süre</translation>
        </message>
        <message>
            <source>Last run</source>
            <translation>Son çalışma</translation>
        </message>
        <message>
            <source>Reading</source>
            <translation>Okunuyor</translation>
        </message>
        <message>
            <source>Waiting for the gateway</source>
            <translation>Ağ geçidi bekleniyor</translation>
        </message>
        <message>
            <source>Failed</source>
            <translation>Başarısız</translation>
        </message>
        <message>
            <source>Not checked</source>
            <translation>Denetlenmedi</translation>
        </message>
        <message numerus="yes">
            <source>%Ln error(s)</source>
            <translation>
                <numerusform>%Ln hata</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <source>%Ln warning(s)</source>
            <translation>
                <numerusform>%Ln uyarı</numerusform>
            </translation>
        </message>
        <message>
            <source>Fine</source>
            <translation>Sorunsuz</translation>
        </message>
        <message>
            <source>Never</source>
            <translation>Hiç</translation>
        </message>
        <message>
            <source>Running</source>
            <translation>Çalışıyor</translation>
        </message>
        <message>
            <source>Complete, %1</source>
            <translation>Tamamlandı, %1</translation>
        </message>
        <message>
            <source>Cancelled</source>
            <translation>İptal edildi</translation>
        </message>
        <message>
            <source>Refused by the check</source>
            <translation>Denetimde reddedildi</translation>
        </message>
        <message>
            <source>Stopped by an alarm</source>
            <translation>Alarmla durdu</translation>
        </message>
        <message>
            <source>Interrupted</source>
            <translation>Kesildi</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::JobsPage</name>
        <message>
            <source>Drop G-code files here to send them to the gateway</source>
            <translation>Ağ geçidine göndermek için G kodu dosyalarını buraya bırakın</translation>
        </message>
        <message>
            <source>Choose a file…</source>
            <translation>Dosya seç…</translation>
        </message>
        <message>
            <source>Start</source>
            <translation>Başlat</translation>
        </message>
        <message>
            <source>Check</source>
            <translation>Denetle</translation>
        </message>
        <message>
            <source>Show</source>
            <translation>Göster</translation>
        </message>
        <message>
            <source>Delete</source>
            <translation>Sil</translation>
        </message>
        <message>
            <source>Jobs on the gateway</source>
            <translation>Ağ geçidindeki işler</translation>
        </message>
        <message>
            <source>What the check has found</source>
            <translation>Denetimin buldukları</translation>
        </message>
        <message>
            <source>Lines of the job</source>
            <translation>İşin satırları</translation>
        </message>
        <message>
            <source>Choose a finding: its line is shown here, its place in the scene.</source>
            <translation>Bir bulgu seçin: satırı burada, yeri sahnede gösterilir.</translation>
        </message>
        <message>
            <source>Checking %1…</source>
            <translation>%1 denetleniyor…</translation>
        </message>
        <message numerus="yes">
            <source>%1: %Ln error(s). It will not start.</source>
            <translation>
                <numerusform>%1: %Ln hata. Başlamayacak.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <source>%1: it can be printed, with %Ln warning(s). It takes %2.</source>
            <translation>
                <numerusform>%1: %Ln uyarıyla basılabilir. Süresi %2.</numerusform>
            </translation>
        </message>
        <message>
            <source>%1: nothing is wrong. It takes %2.</source>
            <translation>%1: hiçbir sorun yok. Süresi %2.</translation>
        </message>
        <message>
            <source>The gateway checks a whole job against every limit before anything moves.</source>
            <translation>Ağ geçidi, bir şey kımıldamadan önce işin tümünü her sınıra karşı denetler.</translation>
        </message>
        <message>
            <source>%1 of %2 used</source>
            <translation>%2 içinden %1 dolu</translation>
        </message>
        <message>
            <source>Send G-code to the gateway</source>
            <translation>Ağ geçidine G kodu gönder</translation>
        </message>
        <message>
            <source>G-code (*.gcode *.ngc *.nc *.g *.gco)</source>
            <translation>G kodu (*.gcode *.ngc *.nc *.g *.gco)</translation>
        </message>
        <message>
            <source>All files (*)</source>
            <translation>Tüm dosyalar (*)</translation>
        </message>
        <message>
            <source>Delete %1 from the gateway?</source>
            <translation>%1 ağ geçidinden silinsin mi?</translation>
        </message>
        <message>
            <source>Keep</source>
            <translation>Tut</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::JogPage</name>
        <message>
            <source>Jog</source>
            <translation>Elle sürme</translation>
        </message>
        <message>
            <source>Keys: arrows move X and Y, Page Up and Page Down move Z, A and D tilt, Q and W turn the table, 1 to 5 choose the step.</source>
            <translation>Tuşlar: oklar X ve Y'yi, Page Up ve Page Down Z'yi sürer; A ve D eğer, Q ve W tablayı döndürür, 1–5 adımı seçer.</translation>
        </message>
        <message>
            <source>Step, mm or °</source>
            <translation>Adım, mm ya da °</translation>
        </message>
        <message>
            <source>Speed</source>
            <translation>Hız</translation>
        </message>
        <message>
            <source>mm/s</source>
            <translation>mm/sn</translation>
        </message>
        <message>
            <source>Machine</source>
            <translation>Makine</translation>
        </message>
        <message>
            <source>Home</source>
            <translation>Eve gönder</translation>
        </message>
        <message>
            <source>Wakes the nodes and brings all carriages to their switches</source>
            <translation>Düğümleri uyandırır ve bütün arabaları anahtarlarına götürür</translation>
        </message>
        <message>
            <source>Bed reference</source>
            <translation>Tabla referansı</translation>
        </message>
        <message>
            <source>Goes to where every job begins</source>
            <translation>Her işin başladığı yere gider</translation>
        </message>
        <message>
            <source>Pause</source>
            <translation>Duraklat</translation>
        </message>
        <message>
            <source>Clear stop</source>
            <translation>Durdurmayı temizle</translation>
        </message>
        <message>
            <source>Motors off</source>
            <translation>Motorları kapat</translation>
        </message>
        <message>
            <source>Positions are lost: the machine must be homed again</source>
            <translation>Konumlar yitirilir: makine yeniden eve gönderilmelidir</translation>
        </message>
        <message>
            <source>Work offsets</source>
            <translation>İş ofsetleri</translation>
        </message>
        <message>
            <source>Coordinate system</source>
            <translation>Koordinat sistemi</translation>
        </message>
        <message>
            <source>Zero here</source>
            <translation>Burası sıfır</translation>
        </message>
        <message>
            <source>The tool's position becomes the zero of this system</source>
            <translation>Takımın konumu bu sistemin sıfırı olur</translation>
        </message>
        <message>
            <source>Set</source>
            <translation>Ayarla</translation>
        </message>
        <message>
            <source>The values above become the zero of this system</source>
            <translation>Yukarıdaki değerler bu sistemin sıfırı olur</translation>
        </message>
        <message>
            <source>Active: %1, zero at %2</source>
            <translation>Etkin: %1, sıfırı %2</translation>
        </message>
        <message>
            <source>Zeros of the work coordinates</source>
            <translation>İş koordinatlarının sıfırları</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::MachineFileEditor</name>
        <message>
            <source>Read again</source>
            <translation>Yeniden oku</translation>
        </message>
        <message>
            <source>Undo</source>
            <translation>Geri al</translation>
        </message>
        <message>
            <source>Save on the gateway</source>
            <translation>Ağ geçidine kaydet</translation>
        </message>
        <message>
            <source>Machine file</source>
            <translation>Makine dosyası</translation>
        </message>
        <message>
            <source>What is wrong in the machine file</source>
            <translation>Makine dosyasındaki yanlışlar</translation>
        </message>
        <message>
            <source>Saved. The gateway uses it from its next start.</source>
            <translation>Kaydedildi. Ağ geçidi bir sonraki açılıştan sonra kullanır.</translation>
        </message>
        <message>
            <source>The built-in machine file</source>
            <translation>Yerleşik makine dosyası</translation>
        </message>
        <message>
            <source>Not read yet</source>
            <translation>Henüz okunmadı</translation>
        </message>
        <message>
            <source>cannot be changed from here</source>
            <translation>buradan değiştirilemez</translation>
        </message>
        <message>
            <source>newer than what the gateway runs with</source>
            <translation>ağ geçidinin kullandığından yeni</translation>
        </message>
        <message>
            <source>The machine file says what the machine is: kinematics, axes, limits, nodes.</source>
            <translation>Makine dosyası makinenin ne olduğunu söyler: kinematik, eksenler, sınırlar, düğümler.</translation>
        </message>
        <message>
            <source>Checking…</source>
            <translation>Denetleniyor…</translation>
        </message>
        <message>
            <source>The file is right.</source>
            <translation>Dosya doğru.</translation>
        </message>
        <message numerus="yes">
            <source>%Ln mistake(s): it cannot be saved.</source>
            <translation>
                <numerusform>%Ln yanlış: kaydedilemez.</numerusform>
            </translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::MachinePage</name>
        <message>
            <source>Axes and nodes</source>
            <translation>Eksenler ve düğümler</translation>
        </message>
        <message>
            <source>Bus and time</source>
            <translation>Veri yolu ve zaman</translation>
        </message>
        <message>
            <source>Machine file</source>
            <translation>Makine dosyası</translation>
        </message>
        <message>
            <source>Axes</source>
            <translation>Eksenler</translation>
        </message>
        <message>
            <source>Nodes</source>
            <translation>Düğümler</translation>
        </message>
        <message>
            <source>Bus load</source>
            <translation>Veri yolu yükü</translation>
        </message>
        <message>
            <source>%1 µs</source>
            <translation>%1 µs</translation>
        </message>
        <message>
            <source>Largest clock error</source>
            <translation>En büyük saat hatası</translation>
        </message>
        <message>
            <source>Emptiest queue</source>
            <translation>En boş kuyruk</translation>
        </message>
        <message>
            <source>Path rate</source>
            <translation>Yol hızı oranı</translation>
        </message>
        <message>
            <source>Nozzle temperature</source>
            <translation>Nozul sıcaklığı</translation>
        </message>
        <message>
            <source>Bed temperature</source>
            <translation>Tabla sıcaklığı</translation>
        </message>
        <message>
            <source>Frames sent</source>
            <translation>Gönderilen çerçeve</translation>
        </message>
        <message>
            <source>Frames received</source>
            <translation>Alınan çerçeve</translation>
        </message>
        <message>
            <source>Segments sent</source>
            <translation>Gönderilen parça</translation>
        </message>
        <message>
            <source>Sequence errors</source>
            <translation>Sıra hatası</translation>
        </message>
        <message>
            <source>Underruns</source>
            <translation>Kuyruk boşalması</translation>
        </message>
        <message>
            <source>Unreadable frames</source>
            <translation>Okunamayan çerçeve</translation>
        </message>
        <message>
            <source>Frames of strangers</source>
            <translation>Yabancı çerçeve</translation>
        </message>
        <message>
            <source>Slowed for the bus</source>
            <translation>Veri yolu için yavaşlama</translation>
        </message>
        <message>
            <source>Held for planning</source>
            <translation>Planlama için bekleme</translation>
        </message>
        <message>
            <source>Not connected.</source>
            <translation>Bağlı değil.</translation>
        </message>
        <message>
            <source>%1 · kinematics %2 · %3 axes on %4 nodes · bus %5</source>
            <translation>%1 · kinematik %2 · %4 düğümde %3 eksen · veri yolu %5</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::MainWindow</name>
        <message>
            <source>Gateways</source>
            <translation>Ağ geçitleri</translation>
        </message>
        <message>
            <source>View</source>
            <translation>Görünüm</translation>
        </message>
        <message>
            <source>Jobs</source>
            <translation>İşler</translation>
        </message>
        <message>
            <source>Jog</source>
            <translation>Elle sürme</translation>
        </message>
        <message>
            <source>Console</source>
            <translation>Konsol</translation>
        </message>
        <message>
            <source>Alarms</source>
            <translation>Alarmlar</translation>
        </message>
        <message>
            <source>Machine</source>
            <translation>Makine</translation>
        </message>
        <message>
            <source>Position</source>
            <translation>Konum</translation>
        </message>
        <message>
            <source>Job</source>
            <translation>İş</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::NodesModel</name>
        <message>
            <source>Node</source>
            <translation>Düğüm</translation>
        </message>
        <message>
            <source>State</source>
            <translation>Durum</translation>
        </message>
        <message>
            <source>Clock error</source>
            <translation>Saat hatası</translation>
        </message>
        <message>
            <source>Queue</source>
            <translation>Kuyruk</translation>
        </message>
        <message>
            <source>Inputs</source>
            <translation>Girişler</translation>
        </message>
        <message>
            <source>Segments sent</source>
            <translation>Gönderilen parça</translation>
        </message>
        <message>
            <source>Faults</source>
            <translation>Arızalar</translation>
        </message>
        <message>
            <source>Not there</source>
            <translation>Yok</translation>
        </message>
        <message>
            <source>Stopped</source>
            <translation>Durdu</translation>
        </message>
        <message>
            <source>Starting</source>
            <translation>Başlıyor</translation>
        </message>
        <message>
            <source>Idle</source>
            <translation>Boşta</translation>
        </message>
        <message>
            <source>Operational</source>
            <translation>Çalışır durumda</translation>
        </message>
        <message>
            <source>Operational, not in time</source>
            <translation>Çalışır, eşzamanlı değil</translation>
        </message>
        <message>
            <source>Waiting</source>
            <translation>Bekliyor</translation>
        </message>
        <message>
            <source>%1 µs</source>
            <translation>%1 µs</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::PositionPanel</name>
        <message>
            <source>Carriages and axes</source>
            <translation>Arabalar ve eksenler</translation>
        </message>
        <message>
            <source>Heat</source>
            <translation>Isı</translation>
        </message>
        <message>
            <source>Target temperature of the nozzle</source>
            <translation>Nozulun hedef sıcaklığı</translation>
        </message>
        <message>
            <source>Target temperature of the bed</source>
            <translation>Tablanın hedef sıcaklığı</translation>
        </message>
        <message>
            <source>off</source>
            <translation>kapalı</translation>
        </message>
        <message>
            <source>Bed</source>
            <translation>Tabla</translation>
        </message>
        <message>
            <source>Nozzle</source>
            <translation>Nozul</translation>
        </message>
        <message>
            <source>Fan</source>
            <translation>Fan</translation>
        </message>
        <message>
            <source>Tool over the part</source>
            <translation>Parçaya göre takım</translation>
        </message>
        <message>
            <source>Position not known yet</source>
            <translation>Konum henüz bilinmiyor</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::ProblemsModel</name>
        <message>
            <source>Error</source>
            <translation>Hata</translation>
        </message>
        <message>
            <source>Warning</source>
            <translation>Uyarı</translation>
        </message>
        <message>
            <source>Kind</source>
            <translation>Tür</translation>
        </message>
        <message>
            <source>Line</source>
            <translation>Satır</translation>
        </message>
        <message>
            <source>What is wrong</source>
            <translation>Sorun</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::Session</name>
        <message>
            <source>expected %1</source>
            <translation>beklenen: %1</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::SocketLink</name>
        <message>
            <source>the gateway closed the connection</source>
            <translation>ağ geçidi bağlantıyı kapattı</translation>
        </message>
        <message>
            <source>on this computer</source>
            <translation>bu bilgisayarda</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::TopBar</name>
        <message>
            <source>STOP</source>
            <translation>DUR</translation>
        </message>
        <message>
            <source>Stops all motion at once, on the path (Ctrl+.)</source>
            <translation>Bütün hareketi hemen, yol üzerinde durdurur (Ctrl+.)</translation>
        </message>
        <message>
            <source>Language</source>
            <translation>Dil</translation>
        </message>
        <message>
            <source>Light or dark</source>
            <translation>Açık ya da koyu</translation>
        </message>
        <message>
            <source>Take control</source>
            <translation>Denetimi al</translation>
        </message>
        <message>
            <source>%1 has control</source>
            <translation>Denetim %1 programında</translation>
        </message>
        <message>
            <source>Not connected</source>
            <translation>Bağlı değil</translation>
        </message>
        <message>
            <source>Connecting</source>
            <translation>Bağlanıyor</translation>
        </message>
        <message>
            <source>Connection lost</source>
            <translation>Bağlantı koptu</translation>
        </message>
        <message>
            <source>A job on the machine goes on.</source>
            <translation>Makinedeki iş sürer.</translation>
        </message>
        <message>
            <source>Connect</source>
            <translation>Bağlan</translation>
        </message>
        <message>
            <source>%1 · %2</source>
            <translation>%1 · %2</translation>
        </message>
        <message>
            <source>Choose a gateway</source>
            <translation>Bir ağ geçidi seçin</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::UsbLink</name>
        <message>
            <source>the USB cable was pulled</source>
            <translation>USB kablosu çekildi</translation>
        </message>
        <message>
            <source>the gateway is not plugged in</source>
            <translation>ağ geçidi takılı değil</translation>
        </message>
        <message>
            <source>this user may not use the USB device: install the udev rule of the package</source>
            <translation>bu kullanıcı USB aygıtını kullanamıyor: paketin udev kuralını kurun</translation>
        </message>
        <message>
            <source>another program uses the gateway's USB link</source>
            <translation>ağ geçidinin USB bağlantısını başka bir program kullanıyor</translation>
        </message>
        <message>
            <source>the USB link does not start</source>
            <translation>USB bağlantısı başlamıyor</translation>
        </message>
        <message>
            <source>USB %1</source>
            <translation>USB %1</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::ViewPage</name>
        <message>
            <source>The 3D scene cannot be shown: %1</source>
            <translation>3B sahne gösterilemiyor: %1</translation>
        </message>
        <message>
            <source>Scene: machine and tool path</source>
            <translation>Sahne: makine ve takım yolu</translation>
        </message>
        <message>
            <source>Show the layers up to here</source>
            <translation>Katmanları buraya kadar göster</translation>
        </message>
        <message>
            <source>Colour by</source>
            <translation>Renk</translation>
        </message>
        <message>
            <source>Feed</source>
            <translation>İlerleme hızı</translation>
        </message>
        <message>
            <source>Layer</source>
            <translation>Katman</translation>
        </message>
        <message>
            <source>Limit margin</source>
            <translation>Sınıra uzaklık</translation>
        </message>
        <message>
            <source>Colour of the tool path</source>
            <translation>Takım yolunun rengi</translation>
        </message>
        <message>
            <source>Machine</source>
            <translation>Makine</translation>
        </message>
        <message>
            <source>Reach of the tool</source>
            <translation>Takımın erişimi</translation>
        </message>
        <message>
            <source>Moves without extrusion</source>
            <translation>Ekstrüzyonsuz hareketler</translation>
        </message>
        <message>
            <source>What is not printed yet</source>
            <translation>Henüz basılmayan</translation>
        </message>
        <message>
            <source>From a corner</source>
            <translation>Köşeden</translation>
        </message>
        <message>
            <source>From above</source>
            <translation>Üstten</translation>
        </message>
        <message>
            <source>From the front</source>
            <translation>Önden</translation>
        </message>
        <message>
            <source>Whole machine (M)</source>
            <translation>Bütün makine (M)</translation>
        </message>
        <message>
            <source>The part alone (F)</source>
            <translation>Yalnız parça (F)</translation>
        </message>
        <message>
            <source>%1 mm/s</source>
            <translation>%1 mm/sn</translation>
        </message>
        <message>
            <source>at a limit</source>
            <translation>sınırda</translation>
        </message>
        <message>
            <source>free</source>
            <translation>serbest</translation>
        </message>
        <message>
            <source>%1 cannot be shown: %2</source>
            <translation>%1 gösterilemiyor: %2</translation>
        </message>
        <message>
            <source>Reading %1</source>
            <translation>%1 okunuyor</translation>
        </message>
        <message>
            <source>%1 · %2 lines · %3 layers · %4 m of path</source>
            <translation>%1 · %2 satır · %3 katman · %4 m yol</translation>
        </message>
        <message numerus="yes">
            <source>%Ln line(s) with expressions are not drawn</source>
            <translation>
                <numerusform>ifadeli %Ln satır çizilmedi</numerusform>
            </translation>
        </message>
        <message>
            <source>No job is shown. Choose one on the Jobs page.</source>
            <translation>Gösterilen iş yok. İşler sayfasından seçin.</translation>
        </message>
        <message>
            <source>%1 mm</source>
            <translation>%1 mm</translation>
        </message>
    </context>
<context>
    <name>GatewayWords</name>
    <message>
        <source>move done</source>
        <translation>hareket bitti</translation>
    </message>
    <message>
        <source>job done: %1</source>
        <translation>iş bitti: %1</translation>
    </message>
    <message>
        <source>all lines done: %1</source>
        <translation>bütün satırlar bitti: %1</translation>
    </message>
    <message>
        <source>the job was not begun: it has %1 errors</source>
        <translation>iş başlatılmadı: %1 hata var</translation>
    </message>
    <message>
        <source>stop by command</source>
        <translation>komutla durduruldu</translation>
    </message>
    <message>
        <source>homed</source>
        <translation>eve gönderildi, konumlar biliniyor</translation>
    </message>
    <message>
        <source>%1 has control</source>
        <translation>denetim %1 programında</translation>
    </message>
    <message>
        <source>nobody has control</source>
        <translation>denetim kimsede değil</translation>
    </message>
    <message>
        <source>the job %1 was interrupted: resume to go on with it, or cancel</source>
        <translation>%1 işi yarıda kaldı: sürdürün ya da iptal edin</translation>
    </message>
    <message>
        <source>the job %1 goes on</source>
        <translation>%1 işi sürüyor</translation>
    </message>
    <message>
        <source>cancelled: positions are known</source>
        <translation>iptal edildi: konumlar biliniyor</translation>
    </message>
    <message>
        <source>cleared: bring the machine up again</source>
        <translation>temizlendi: makineyi yeniden uyandırın</translation>
    </message>
    <message>
        <source>cleared: resume brings the machine up again and goes on with the job</source>
        <translation>temizlendi: sürdürünce makine uyanır ve iş devam eder</translation>
    </message>
    <message>
        <source>%1 is %2 outside the workspace</source>
        <translation>%1 çalışma alanının %2 dışında</translation>
    </message>
    <message>
        <source>%1: out of reach, the leg is %2 too short</source>
        <translation>%1: erişilemez, bacak %2 kısa kalıyor</translation>
    </message>
    <message>
        <source>%1: would be %2 beyond its travel</source>
        <translation>%1: hareket sınırını %2 aşar</translation>
    </message>
    <message>
        <source>%1: the leg leans %2 too far from its rail</source>
        <translation>%1: bacak rayından %2 fazla eğiliyor</translation>
    </message>
    <message>
        <source>%1: leg, rail and platform come %2 too near to each other</source>
        <translation>%1: bacak, ray ve platform birbirine %2 fazla yaklaşıyor</translation>
    </message>
    <message>
        <source>too near to a singular pose: condition number %1</source>
        <translation>tekil duruşa çok yakın: koşul sayısı %1</translation>
    </message>
    <message>
        <source>filament is fed before the job has set a hotend temperature (M104)</source>
        <translation>iş bir nozul sıcaklığı (M104) vermeden filament sürülüyor</translation>
    </message>
    <message>
        <source>filament is fed with the hotend at %1 °C; at least %2 °C is needed</source>
        <translation>nozul %1 °C iken filament sürülüyor; en az %2 °C gerekir</translation>
    </message>
    <message>
        <source>M112 stops the machine here</source>
        <translation>M112 makineyi burada durdurur</translation>
    </message>
    <message>
        <source>settings are kept in the machine file: M500 to M503 do nothing in a job</source>
        <translation>ayarlar makine dosyasında durur: M500–M503 bir işte etkisizdir</translation>
    </message>
    <message>
        <source>this machine has no heater for the hotend</source>
        <translation>bu makinenin nozul ısıtıcısı yok</translation>
    </message>
    <message>
        <source>this machine has no heater for the bed</source>
        <translation>bu makinenin tabla ısıtıcısı yok</translation>
    </message>
    <message>
        <source>hotend temperature %1 °C; allowed are 0 to %2 °C</source>
        <translation>nozul sıcaklığı %1 °C; izin verilen 0–%2 °C</translation>
    </message>
    <message>
        <source>bed temperature %1 °C; allowed are 0 to %2 °C</source>
        <translation>tabla sıcaklığı %1 °C; izin verilen 0–%2 °C</translation>
    </message>
    <message>
        <source>a job cannot manage stored jobs: M20 to M32 belong to a session</source>
        <translation>bir iş depolanan işleri yönetemez: M20–M32 oturuma aittir</translation>
    </message>
</context>
</TS>
