// web/src/ui/sheet.ts: styles that a part of the page brings along, so that the first load does without them. They come
// after the page's own.

export function adopt(css: string): void {
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(css);
  document.adoptedStyleSheets.push(sheet);
}
