// web/src/experiments/templates.ts: documents to begin with.

export interface Template { name: string; label: string; help: string; document: unknown }

export const templates: Template[] = [
  {
    name: "controllers", label: "Controllers",
    help: "Three controllers in the papers' nine worlds, against the original elastic strip.",
    document: {
      name: "controllers",
      scenarios: ["case1", "case2", "case3", "case4", "exp1", "exp2", "exp3", "exp4", "wall"],
      controllers: ["original", "modified", "strip"],
      repeats: 3, seed: 1, physics: "kinematic",
      comparisons: { baseline: "original" },
    },
  },
  {
    name: "layouts", label: "Random worlds",
    help: "Two controllers in 100 random layouts of three obstacles, one seed each.",
    document: {
      name: "random-worlds",
      scenarios: [{ random_layouts: { count: 100, seed: 1, obstacles: 3, k_r: 0.3 } }],
      controllers: ["original", "strip"],
      physics: "kinematic",
      comparisons: { baseline: "original" },
    },
  },
  {
    name: "gains", label: "Gains",
    help: "The two gains of the modified strip, over a grid, in three worlds.",
    document: {
      name: "gains",
      scenarios: ["case1", "case3", "exp2"],
      controllers: ["modified"],
      sweep: { grid: { k_r: [0.2, 0.3, 0.4, 0.6], d_safe: [0.7, 1.0] } },
      repeats: 3, physics: "kinematic",
    },
  },
];
