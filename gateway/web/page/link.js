// The gateway's API: one websocket for statuses, events and requests (messages of kinebus.proto as JSON), opened again when
// it breaks; uploads and the emergency stop by HTTP.
const kVersionMajor = 2;
const kAgainAfterMs = 1500;

export class Link extends EventTarget {
  #socket = null;
  #waits = new Map();
  #last = 0;
  #wanted = true;

  get wanted() {
    return this.#wanted;
  }

  /// `key` may be empty: gateways have networks that need none.
  constructor(key) {
    super();
    this.key = key;
  }

  open() {
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    const socket = new WebSocket(`${scheme}://${location.host}/kinebus/v1/socket`);
    this.#socket = socket;
    socket.onopen = async () => {
      try {
        const hello = await this.request('hello', { version_major: kVersionMajor, client_name: 'web page', token: btoa(this.key) });
        await this.request('watch', { status_hz: 5, events: true });
        this.#tell('open', hello.hello);
      } catch (problem) {
        if (problem.code === 'ERROR_NOT_ALLOWED' || problem.code === 'ERROR_VERSION') this.#tell('refused', problem);
      }
    };
    socket.onmessage = (message) => this.#take(JSON.parse(message.data));
    socket.onclose = () => {
      for (const wait of this.#waits.values()) wait.reject({ rule: 'the link broke before the answer came', code: 'ERROR_LINK_LOST' });
      this.#waits.clear();
      this.#tell('closed');
      if (this.#wanted) setTimeout(() => this.#wanted && this.open(), kAgainAfterMs);
    };
  }

  close() {
    this.#wanted = false;
    this.#socket?.close();
  }

  /// Gives the reply; what is refused is thrown as the Problem.
  request(name, fields = {}) {
    return new Promise((resolve, reject) => {
      if (this.#socket?.readyState !== WebSocket.OPEN) return reject({ rule: 'there is no link to the gateway', code: 'ERROR_LINK_LOST' });
      const request_id = ++this.#last;
      this.#waits.set(request_id, { resolve, reject });
      this.#socket.send(JSON.stringify({ request_id, [name]: fields }));
    });
  }

  /// By a request of its own as well: never behind what else waits in the socket.
  async stop() {
    const ways = [this.#http('POST', '/kinebus/v1/stop'), this.request('stop')];
    const results = await Promise.allSettled(ways);
    if (results.every((result) => result.status === 'rejected')) throw results[1].reason;
  }

  upload(file, progress) {
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest();
      request.open('PUT', '/api/v1/files/local/' + encodeURIComponent(file.name));
      if (this.key) request.setRequestHeader('X-Api-Key', this.key);
      request.setRequestHeader('Overwrite', '?1');
      request.setRequestHeader('Content-Type', 'text/x.gcode');
      request.upload.onprogress = (event) => progress(event.loaded / Math.max(event.total, 1));
      request.onload = () => {
        if (request.status < 300) return resolve();
        let rule = request.statusText;
        try { rule = JSON.parse(request.responseText).error; } catch { /* the status line tells it */ }
        reject({ rule });
      };
      request.onerror = () => reject({ rule: 'the link broke before the answer came' });
      request.send(file);
    });
  }

  async download(name) {
    const response = await this.#http('GET', '/downloads/files/local/' + encodeURIComponent(name));
    return response.blob();
  }

  async picture(name, great) {
    const response = await this.#http('GET', `/thumb/${great ? 'l' : 's'}/local/${encodeURIComponent(name)}`);
    return response.blob();
  }

  async #http(method, path) {
    const response = await fetch(path, { method, headers: this.key ? { 'X-Api-Key': this.key } : {} });
    if (!response.ok) throw { rule: (await response.json()).error };
    return response;
  }

  #take(message) {
    if (message.status) return this.#tell('status', message.status);
    if (message.event) return this.#tell('event', message.event);
    const wait = this.#waits.get(message.reply?.request_id);
    if (!wait) return;
    this.#waits.delete(message.reply.request_id);
    if (message.reply.error) wait.reject(message.reply.error);
    else wait.resolve(message.reply);
  }

  #tell(what, detail) {
    this.dispatchEvent(new CustomEvent(what, { detail }));
  }
}
