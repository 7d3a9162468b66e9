// web/src/css.d.ts: style sheets are imported for the bundler: into the page's own, or, with "?text", as text that a
// part of the page brings along.
declare module "*.css";
declare module "*.css?text" {
  const text: string;
  export default text;
}
