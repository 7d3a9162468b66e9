// web/src/teleop/hid_report.ts: reports of a HID device, found and packed by its own descriptor as WebHID parses it.
// Source: USB HID 1.11, sections 5.6, 6.2.2 and 8.

/** The parts of WebHID that count; the DOM's types have none of it. A usage is page << 16 | usage. */
export interface HidItem {
  isArray?: boolean;
  isConstant?: boolean;
  isRange?: boolean;
  usages?: readonly number[];
  usageMinimum?: number;
  usageMaximum?: number;
  reportSize?: number;  // [bits] of one value
  reportCount?: number; // values
  logicalMinimum?: number;
  logicalMaximum?: number;
  unitExponent?: number;           // the unit is 10 to this power
  unitFactorTimeExponent?: number; // 1: of a second
}
export interface HidReport { reportId?: number; items?: readonly HidItem[] }
export interface HidCollection {
  usagePage?: number;
  usage?: number;
  children?: readonly HidCollection[];
  outputReports?: readonly HidReport[];
  featureReports?: readonly HidReport[];
}
export interface HidDevice {
  readonly opened: boolean;
  readonly productName: string;
  readonly collections: readonly HidCollection[];
  open(): Promise<void>;
  close(): Promise<void>;
  sendReport(id: number, data: BufferSource): Promise<void>;
  sendFeatureReport(id: number, data: BufferSource): Promise<void>;
  receiveFeatureReport(id: number): Promise<DataView>;
}
export interface Hid extends EventTarget {
  requestDevice(options: { filters: { usagePage: number; usage?: number }[] }): Promise<HidDevice[]>;
}

/** One value of a report. */
export interface Field {
  bit: number;  // its first, from the start of the data
  size: number; // [bits]
  min: number;
  max: number;
  usages: readonly number[]; // one; of an array all that its value may name
  array: boolean;
  unit: number; // [s] of a time
}

const kMillisecond = 1e-3; // [s] the usual unit of a time

/** The values of a report in order, without its constants. Of values without a usage of their own, the last usage holds. */
export class Layout {
  readonly fields: Field[] = [];
  readonly bytes: number;

  constructor(readonly id: number, readonly feature: boolean, items: readonly HidItem[]) {
    let bit = 0;
    for (const item of items) {
      const size = item.reportSize ?? 0, count = item.reportCount ?? 0;
      const usages = usages_of(item);
      const [min, max] = range_of(item, size);
      const unit = item.unitFactorTimeExponent === 1 ? 10 ** (item.unitExponent ?? 0) : kMillisecond;
      for (let i = 0; i < count && !item.isConstant; ++i) {
        const own = item.isArray ? usages : usages.slice(Math.min(i, usages.length - 1)).slice(0, 1);
        this.fields.push({ bit: bit + i * size, size, min, max, usages: own, array: item.isArray ?? false, unit });
      }
      bit += size * count;
    }
    this.bytes = Math.ceil(bit / 8);
  }

  field(usage: number): Field | undefined {
    return this.fields.find((f) => f.usages.includes(usage));
  }

  /** The data of the report with the `values` of usages; what the report does not have is left out. Of an array the
   * usage with a value other than 0 is named. Values are held within the field's range; NaN is no value. */
  pack(values: ReadonlyMap<number, number>): Uint8Array<ArrayBuffer> {
    const out = new Uint8Array(this.bytes);
    for (const [usage, value] of values) {
      const f = this.field(usage);
      if (!f || (f.array && value === 0)) continue;
      put(out, f, f.array ? f.min + f.usages.indexOf(usage) : raw_of(f, value));
    }
    return out;
  }

  /** The value of `usage` in `data`, as it was received: of an array, whether it names the usage. Null without it. */
  read(data: DataView, usage: number): number | null {
    const f = this.field(usage);
    // A device with numbered reports sends the number first.
    const from = data.byteLength > this.bytes && this.id !== 0 && data.getUint8(0) === this.id ? 1 : 0;
    if (!f || data.byteLength < from + Math.ceil((f.bit + f.size) / 8)) return null;
    let raw = 0;
    for (let i = 0; i < f.size; ++i) {
      const bit = f.bit + i;
      if ((data.getUint8(from + (bit >> 3)) >> (bit & 7)) & 1) raw += 2 ** i;
    }
    if (f.min < 0 && raw >= 2 ** (f.size - 1)) raw -= 2 ** f.size;
    return f.array ? Number(f.usages[raw - f.min] === usage) : raw;
  }
}

/** No value has all bits set, if that lies outside of the field's range; else it is the least one. */
function raw_of(f: Field, value: number): number {
  const none = 2 ** f.size - 1;
  if (Number.isNaN(value)) return none > f.max ? none : f.min;
  return Math.max(f.min, Math.min(f.max, Math.round(value)));
}

function put(out: Uint8Array, f: Field, raw: number): void {
  const bits = raw < 0 ? raw + 2 ** f.size : raw;
  for (let i = 0; i < f.size; ++i) {
    const bit = f.bit + i;
    if (Math.floor(bits / 2 ** i) % 2 === 1) out[bit >> 3] |= 1 << (bit & 7);
  }
}

function usages_of(item: HidItem): readonly number[] {
  if (!item.isRange) return item.usages ?? [];
  const from = item.usageMinimum ?? 0;
  return Array.from({ length: Math.max(0, Math.min(4096, (item.usageMaximum ?? 0) - from + 1)) }, (_, i) => from + i);
}

/** A maximum below the minimum is an unsigned one that was read as signed. */
function range_of(item: HidItem, size: number): [number, number] {
  const min = item.logicalMinimum ?? 0, max = item.logicalMaximum ?? 0;
  return [min, max < min ? 2 ** size - 1 : max];
}

/** The report that the collection with one of `usages` describes; null if the device has none. */
export function find_report(roots: readonly HidCollection[], ...usages: number[]): Layout | null {
  for (const root of roots) {
    const found = within(root, usages);
    for (const feature of found ? [false, true] : []) {
      const reports = (c: HidCollection) => (feature ? c.featureReports : c.outputReports) ?? [];
      const id = reports(found!)[0]?.reportId;
      // The root lists the whole report, with what lies beside the collection.
      const whole = reports(root).find((r) => r.reportId === id) ?? reports(found!)[0];
      if (whole?.items?.length) return new Layout(id ?? 0, feature, whole.items);
    }
  }
  return null;
}

function within(c: HidCollection, usages: readonly number[]): HidCollection | null {
  if (usages.includes(((c.usagePage ?? 0) << 16) | (c.usage ?? 0))) return c;
  for (const child of c.children ?? []) {
    const found = within(child, usages);
    if (found) return found;
  }
  return null;
}
