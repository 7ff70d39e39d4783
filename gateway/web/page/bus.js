// The bus and its nodes: how full it is, who is there, how much motion waits in each.
import { Course } from './course.js';
import { number, percent, t } from './words.js';

const at = (id) => document.getElementById(id);
/// Of a bus that carries one machine.
const kUsualLoad = 50;
const kNmt = { 0: 'NMT_BOOT_UP', 4: 'NMT_STOPPED', 5: 'NMT_OPERATIONAL', 127: 'NMT_PRE_OPERATIONAL' };

export class Bus {
  #load = new Course(at('bus-graph'), kUsualLoad);

  begin() {
    this.#load.begin(['']);
  }

  recolour() {
    this.#load.recolour();
  }

  show(status) {
    this.#load.add([100 * status.bus_load]);
    at('bus-load').textContent = t('load', percent(status.bus_load, 1), percent(status.bus_load_peak, 1));
    at('nodes').replaceChildren(...status.nodes.map((node) => {
      const row = document.createElement('tr');
      const has_queue = node.queue_capacity > 0;
      const words = [number(node.id), t(node.present ? kNmt[node.nmt_state] ?? String(node.nmt_state) : 'NMT_ABSENT'),
        has_queue ? percent(node.queue_records / node.queue_capacity) : '–',
        node.synchronised ? `${number(1e6 * node.sync_error_s, 1)} µs` : '–'];
      row.replaceChildren(...words.map((word) => Object.assign(document.createElement('td'), { textContent: word })));
      return row;
    }));
  }
}
