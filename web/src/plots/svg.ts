// web/src/plots/svg.ts: the calls of a canvas context as an SVG file, so that a picture has the same
// drawing as the screen. It knows the calls that the page's drawings make.
type Matrix = [number, number, number, number, number, number];

interface State {
  matrix: Matrix;
  fill: string;
  stroke: string;
  width: number;
  alpha: number;
  cap: string;
  join: string;
  dash: number[];
  clip: string | null;
}

const round = (v: number) => String(Number(v.toFixed(2)));
const escaped = (text: string) =>
  text.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]!);

const kAnchors: Record<string, string> = { center: "middle", right: "end", end: "end" };
/** From a text's place down to its baseline, in sizes of the font: not every viewer knows other baselines. */
const kDrop: Record<string, number> = { middle: 0.3, top: 0.8, hanging: 0.8 };

/** [px] About as wide as most fonts write `text` at `font`. */
function usual_width(text: string, font: string): number {
  return text.length * 0.56 * (Number(/([\d.]+)px/.exec(font)?.[1]) || 10);
}

export class SvgContext {
  font = "10px sans-serif";
  textAlign = "start";
  textBaseline = "alphabetic";
  private now_: State = {
    matrix: [1, 0, 0, 1, 0, 0], fill: "#000", stroke: "#000", width: 1, alpha: 1, cap: "butt", join: "miter",
    dash: [], clip: null,
  };
  private saved_: State[] = [];
  private path_ = "";
  private drawn_: string[] = [];
  private clips_ = 0;

  constructor(private readonly width_: number, private readonly height_: number,
    private readonly text_width_: (text: string, font: string) => number = usual_width) {}

  set fillStyle(colour: string) { this.now_.fill = colour; }
  get fillStyle(): string { return this.now_.fill; }
  set strokeStyle(colour: string) { this.now_.stroke = colour; }
  get strokeStyle(): string { return this.now_.stroke; }
  set lineWidth(width: number) { this.now_.width = width; }
  get lineWidth(): number { return this.now_.width; }
  set globalAlpha(alpha: number) { this.now_.alpha = alpha; }
  get globalAlpha(): number { return this.now_.alpha; }
  set lineCap(cap: string) { this.now_.cap = cap; }
  set lineJoin(join: string) { this.now_.join = join; }

  save(): void {
    this.saved_.push({ ...this.now_ });
  }
  restore(): void {
    this.now_ = this.saved_.pop() ?? this.now_;
  }
  translate(x: number, y: number): void {
    this.turn(1, 0, 0, 1, x, y);
  }
  rotate(angle: number): void {
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    this.turn(c, s, -s, c, 0, 0);
  }
  scale(x: number, y: number): void {
    this.turn(x, 0, 0, y, 0, 0);
  }
  setLineDash(dash: number[]): void {
    this.now_.dash = [...dash];
  }

  beginPath(): void {
    this.path_ = "";
  }
  closePath(): void {
    if (this.path_ !== "") this.path_ += "Z";
  }
  moveTo(x: number, y: number): void {
    this.path_ += `M${this.at(x, y)}`;
  }
  lineTo(x: number, y: number): void {
    this.path_ += `${this.path_ === "" ? "M" : "L"}${this.at(x, y)}`;
  }
  rect(x: number, y: number, w: number, h: number): void {
    this.path_ += `M${this.at(x, y)}L${this.at(x + w, y)}L${this.at(x + w, y + h)}L${this.at(x, y + h)}Z`;
  }
  roundRect(x: number, y: number, w: number, h: number, r: number): void {
    const [right, low] = [x + w, y + h];
    const corner = (cx: number, cy: number, tx: number, ty: number) => `Q${this.at(cx, cy)} ${this.at(tx, ty)}`;
    this.path_ += `M${this.at(x + r, y)}L${this.at(right - r, y)}${corner(right, y, right, y + r)}` +
      `L${this.at(right, low - r)}${corner(right, low, right - r, low)}` +
      `L${this.at(x + r, low)}${corner(x, low, x, low - r)}L${this.at(x, y + r)}${corner(x, y, x + r, y)}Z`;
  }
  /** A whole turn is two halves: SVG draws no arc that ends where it began. */
  arc(x: number, y: number, radius: number, from: number, to: number, back = false): void {
    const whole = 2 * Math.PI;
    let turn = to - from;
    if (back) turn = turn <= -whole ? -whole : -(((-turn % whole) + whole) % whole);
    else turn = turn >= whole ? whole : ((turn % whole) + whole) % whole;
    const point = (angle: number) => this.at(x + radius * Math.cos(angle), y + radius * Math.sin(angle));
    const r = round(radius * this.size());
    this.path_ += `${this.path_ === "" || /Z$/.test(this.path_) ? "M" : "L"}${point(from)}`;
    const parts = Math.abs(turn) > Math.PI ? 2 : 1;
    for (let i = 1; i <= parts; ++i) {
      this.path_ += `A${r} ${r} 0 0 ${turn > 0 ? 1 : 0} ${point(from + (turn * i) / parts)}`;
    }
  }

  fill(): void {
    if (this.path_ === "") return;
    this.put(`<path d="${this.path_}"${this.filled()}`);
  }
  stroke(): void {
    const { stroke, width, alpha, cap, join, dash } = this.now_;
    if (this.path_ === "") return;
    this.put(`<path d="${this.path_}" fill="none" stroke="${escaped(stroke)}" stroke-width="${round(width * this.size())}"` +
      (alpha < 1 ? ` stroke-opacity="${round(alpha)}"` : "") +
      (cap !== "butt" ? ` stroke-linecap="${cap}"` : "") + (join !== "miter" ? ` stroke-linejoin="${join}"` : "") +
      (dash.length > 0 ? ` stroke-dasharray="${dash.map(round).join(" ")}"` : ""));
  }
  fillRect(x: number, y: number, w: number, h: number): void {
    const before = this.path_;
    this.path_ = "";
    this.rect(x, y, w, h);
    this.fill();
    this.path_ = before;
  }
  clip(): void {
    const id = `clip${++this.clips_}`;
    const within = this.now_.clip ? ` clip-path="url(#${this.now_.clip})"` : "";
    this.drawn_.push(`<clipPath id="${id}"><path d="${this.path_}"${within}/></clipPath>`);
    this.now_.clip = id;
  }
  fillText(text: string, x: number, y: number): void {
    const [weight, size, family] = font_parts(this.font);
    const [px, py] = this.place(x, y + (kDrop[this.textBaseline] ?? 0) * size);
    const angle = (Math.atan2(this.now_.matrix[1], this.now_.matrix[0]) * 180) / Math.PI;
    this.put(`<text x="${round(px)}" y="${round(py)}" font-family="${escaped(family)}" font-size="${round(size * this.size())}"` +
      (weight !== "400" ? ` font-weight="${weight}"` : "") +
      (kAnchors[this.textAlign] ? ` text-anchor="${kAnchors[this.textAlign]}"` : "") +
      (Math.abs(angle) > 1e-6 ? ` transform="rotate(${round(angle)} ${round(px)} ${round(py)})"` : "") +
      this.filled(), escaped(text));
  }
  measureText(text: string): { width: number } {
    return { width: this.text_width_(text, this.font) };
  }

  /** The file, with `title` for readers of the file that do not see it. */
  file(title: string): string {
    const [w, h] = [round(this.width_), round(this.height_)];
    return `<?xml version="1.0" encoding="UTF-8"?>\n` +
      `<svg xmlns="http://www.w3.org/2000/svg" width="${w}" height="${h}" viewBox="0 0 ${w} ${h}" role="img">\n` +
      `<title>${escaped(title)}</title>\n${this.drawn_.join("\n")}\n</svg>\n`;
  }

  private put(start: string, text: string | null = null): void {
    const clip = this.now_.clip ? ` clip-path="url(#${this.now_.clip})"` : "";
    this.drawn_.push(text === null ? `${start}${clip}/>` : `${start}${clip}>${text}</text>`);
  }
  private filled(): string {
    return ` fill="${escaped(this.now_.fill)}"` +
      (this.now_.alpha < 1 ? ` fill-opacity="${Number(this.now_.alpha.toFixed(3))}"` : "");
  }
  private turn(a: number, b: number, c: number, d: number, e: number, f: number): void {
    const [ma, mb, mc, md, me, mf] = this.now_.matrix;
    this.now_.matrix = [ma * a + mc * b, mb * a + md * b, ma * c + mc * d, mb * c + md * d,
      ma * e + mc * f + me, mb * e + md * f + mf];
  }
  private place(x: number, y: number): [number, number] {
    const [a, b, c, d, e, f] = this.now_.matrix;
    return [a * x + c * y + e, b * x + d * y + f];
  }
  private at(x: number, y: number): string {
    const [px, py] = this.place(x, y);
    return `${round(px)} ${round(py)}`;
  }
  /** By how much the matrix enlarges. */
  private size(): number {
    return Math.hypot(this.now_.matrix[0], this.now_.matrix[1]);
  }
}

/** Weight, size [px] and family of "600 12px sans-serif". */
function font_parts(font: string): [string, number, string] {
  const found = /^(?:(\w+)\s+)?([\d.]+)px\s+(.*)$/.exec(font);
  return found ? [found[1] ?? "400", Number(found[2]), found[3]] : ["400", 10, "sans-serif"];
}
