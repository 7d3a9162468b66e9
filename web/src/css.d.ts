// web/src/css.d.ts: style sheets are imported for the bundler only.
declare module "*.css";
