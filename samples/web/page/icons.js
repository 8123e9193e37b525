// The tools' pictures.
const icon = (lines) => `<svg viewBox="0 0 48 48" fill="none" stroke-linecap="round" stroke-linejoin="round" aria-hidden="true">${lines}</svg>`;
const GROUND = '<path d="M3 40h42" stroke="#b98a4e" stroke-width="3"/>';

export const ICONS = {
  dig: icon('<path d="M3 36h10c2 6 18 6 20 0h12" stroke="#b98a4e" stroke-width="3"/><path d="M38 6 24 22" stroke="#e8d5b0" stroke-width="4"/><path d="m26 17 7 6c0 6-6 10-13 11-1-7 0-14 6-17z" fill="#aab4bd" stroke="#dfe6ec" stroke-width="1.5"/>'),
  damp: icon('<path d="M8 40V26h7v-6h6v6h6v-6h6v6h7v14z" fill="#8a5c33" stroke="#6d4522" stroke-width="1.5"/><path d="M35 5c4 5 5 7 5 9a5 5 0 0 1-10 0c0-2 1-4 5-9z" fill="#5fb4dd"/>' + GROUND),
  dry: icon('<path d="M6 40 24 21l18 19z" fill="#e0b26b" stroke="#c3934d" stroke-width="1.5"/><path d="M24 4v4M24 11v3M20 8v2M28 8v2" stroke="#e0b26b" stroke-width="3"/>' + GROUND),
  wall: icon('<path d="M5 40 9 24 37 14l6 9v17z" fill="#8a5c33" stroke="#6d4522" stroke-width="1.5"/><path d="m9 24 28-10" stroke="#f0d9ac" stroke-width="3" stroke-dasharray="1 6"/>' + GROUND),
  castle: icon('<path d="M9 40V16h5v4h4v-4h4v4h4v-4h4v4h4v-4h5v24z" fill="#d9a860" stroke="#a97a3c" stroke-width="1.5"/><path d="M20 40v-7a4 4 0 0 1 8 0v7z" fill="#6d4522"/><path d="M24 16V5l9 3-9 3" fill="#d9534a" stroke="#f2ede2" stroke-width="1.5"/>'),
  water: icon('<path d="M24 4c8 11 11 15 11 20a11 11 0 0 1-22 0c0-5 3-9 11-20z" fill="#4da9d8" stroke="#a8dcf5" stroke-width="1.5"/><path d="M5 42c4-4 8 2 12-1s8 2 12-1 8 2 14-1" stroke="#4da9d8" stroke-width="3"/>'),
  look: icon('<path d="M4 24c8-13 32-13 40 0-8 13-32 13-40 0z" stroke="#f2ede2" stroke-width="3"/><circle cx="24" cy="24" r="6" fill="#ffcf6b"/>'),
};
