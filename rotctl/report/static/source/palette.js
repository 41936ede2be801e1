// Colours of the 3D view, light and dark. Those of the page and its plots are in replay.css.

const LIGHT = {
  skyTop: "#a7c7e6",
  skyLow: "#f1f5f9",
  tileA: "#edeff2",
  tileB: "#d9dfe4",
  label: "#5c6876",
  rim: "#ffffff",
  centre: "#1c222c",
  ghost: "#3f6fd8",
  sun: 2.5,
  hemisphere: 1.7,
};

const DARK = {
  skyTop: "#0b1220",
  skyLow: "#26313f",
  tileA: "#3a4552",
  tileB: "#2f3945",
  label: "#a8b4c2",
  rim: "#ffffff",
  centre: "#10151c",
  ghost: "#7fa6ff",
  sun: 2.3,
  hemisphere: 1.25,
};

// Okabe and Ito's, which also the colour-blind can tell apart; the same in both.
export const MARKS = {
  used: "#eb5812",
  unused: "#8a929c",
  predicted: "#0b84d8",
  centre: "#d99a00",
  omega: "#b0469a",
  momentum: "#0a9d74",
};

const dark = window.matchMedia("(prefers-color-scheme: dark)");

export const palette = () => (dark.matches ? DARK : LIGHT);

export const whenChanged = (callback) => dark.addEventListener("change", callback);
