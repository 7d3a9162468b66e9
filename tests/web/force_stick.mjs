// tests/web/force_stick.mjs: a joystick of the USB class of force feedback, as WebHID shows it, for unit and browser
// tests. Its reports have odd sizes and offsets, so that only packing by the descriptor fits. One function without
// outer names: a browser test sends its source into the page.

export function force_stick() {
  const pid = (usage) => (0x0f << 16) | usage;
  const item = (usages, reportSize, reportCount = 1, more = {}) => ({
    isArray: false, isConstant: false, isRange: false, usages, reportSize, reportCount, logicalMinimum: 0, logicalMaximum: 2 ** reportSize - 1, ...more,
  });
  const pad = (bits) => item([], bits, 1, { isConstant: true });
  const index = item([pid(0x22)], 6, 1, { logicalMinimum: 1, logicalMaximum: 40 });
  const array = (...usages) => item(usages.map(pid), 8, 1, { isArray: true, logicalMinimum: 1, logicalMaximum: usages.length });
  const set_effect = [index, pad(2), array(0x27, 0x26, 0x40), // ramp, constant, spring
    item([pid(0x50)], 16, 1, { unitFactorTimeExponent: 1, unitExponent: -3, logicalMaximum: 32767 }),
    item([pid(0x52)], 8, 1, { logicalMaximum: 200 }), item([pid(0x53)], 8, 1, { logicalMinimum: 1, logicalMaximum: 8 }),
    item([(1 << 16) | 0x30, (1 << 16) | 0x31], 1, 2), item([pid(0x56)], 1), pad(5),
    item([(10 << 16) | 1, (10 << 16) | 2], 16, 2, { logicalMaximum: 35999 })];
  const set_constant = [index, pad(2), item([pid(0x70)], 12, 1, { logicalMinimum: -2000, logicalMaximum: 2000 }), pad(4)];
  const operation = [index, pad(2), array(0x79, 0x7a, 0x7b), item([pid(0x7c)], 8)];
  const gain = [item([pid(0x7e)], 8, 1, { logicalMaximum: 250 })];
  const control = [array(0x97, 0x98, 0x99, 0x9a)];
  const create = [array(0x26, 0x27), item([(1 << 16) | 0x3b], 10), pad(6)];
  const load = [index, pad(2), array(0x8c, 0x8d, 0x8e), item([pid(0xac)], 16)];
  const free = [index, pad(2)];
  const output = { 11: set_effect, 15: set_constant, 20: operation, 23: gain, 22: control, 25: free };
  const feature = { 5: create, 6: load };
  const reports = (map) => Object.entries(map).map(([id, items]) => ({ reportId: Number(id), items }));
  const part = (usage, out, feat = {}) => ({ usagePage: 0x0f, usage, children: [], outputReports: reports(out), featureReports: reports(feat) });
  const collections = [{
    usagePage: 1, usage: 4, inputReports: [], outputReports: reports(output), featureReports: reports(feature),
    children: [part(0x21, { 11: set_effect }), part(0x73, { 15: set_constant }), part(0x77, { 20: operation }), part(0x7d, { 23: gain }),
      part(0x95, { 22: control }), part(0x90, { 25: free }), part(0xab, {}, { 5: create }), part(0x89, {}, { 6: load })],
  }];
  const bits = (bytes, from, size) => {
    let value = 0;
    for (let i = 0; i < size; ++i) value += ((bytes[(from + i) >> 3] >> ((from + i) & 7)) & 1) * 2 ** i;
    return value;
  };
  return {
    opened: false, productName: "Fake force stick", collections,
    sent: [],            // [report id, bytes] in order
    waits: 2,            // answers of Block Load before the effect is there
    gone: false,
    force: { size: 0, angle: 0 }, // [-1, 1] and turns, that it pushes with
    block: 7, effect: null, enabled: false, runs: false,
    async open() {
      this.opened = true;
    },
    async close() {
      this.opened = false;
    },
    async sendFeatureReport(id, data) {
      if (this.gone) throw new Error("NotAllowedError");
      const bytes = [...new Uint8Array(data.buffer, data.byteOffset, data.byteLength)];
      this.sent.push([id, bytes]);
      if (id === 5) this.effect = bytes[0] === 1 ? "constant" : "ramp";
    },
    async receiveFeatureReport(id) {
      const loaded = --this.waits < 0;
      return new DataView(new Uint8Array([id, loaded ? this.block : 0, loaded ? 1 : 3, 0, 0]).buffer);
    },
    async sendReport(id, data) {
      if (this.gone) throw new Error("NotAllowedError");
      const bytes = [...new Uint8Array(data.buffer, data.byteOffset, data.byteLength)];
      this.sent.push([id, bytes]);
      if (id === 22) this.enabled = bytes[0] === 1;
      if (id === 11) this.force.angle = bits(bytes, 56, 16) / 35999;
      if (id === 15) {
        const raw = bits(bytes, 8, 12);
        this.force.size = (raw >= 2048 ? raw - 4096 : raw) / 2000;
      }
      if (id === 20) this.runs = bytes[1] === 1;
    },
  };
}
